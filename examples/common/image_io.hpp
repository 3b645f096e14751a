// Image files: single-channel float EXR for depth and visibility, 8-bit RGB PNG for people.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

// Larger images are refused before anything is allocated for them.
constexpr uint32_t max_image_size = 16384;

struct FloatImage {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<float> texels; // row by row from the top

    FloatImage() = default;
    FloatImage(uint32_t w, uint32_t h, float value = 0.0f)
        : width(w), height(h), texels(static_cast<size_t>(w) * h, value)
    {
    }
    float &at(uint32_t x, uint32_t y)
    {
        return texels[static_cast<size_t>(y) * width + x];
    }
    float at(uint32_t x, uint32_t y) const
    {
        return texels[static_cast<size_t>(y) * width + x];
    }
};

struct ColourImage {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<uint8_t> rgb; // sRGB

    ColourImage() = default;
    ColourImage(uint32_t w, uint32_t h) : width(w), height(h), rgb(static_cast<size_t>(w) * h * 3)
    {
    }
};

// All throw Error naming the file and what was expected.
FloatImage read_exr(const std::string &path);
void write_exr(const std::string &path, const FloatImage &image);
void write_png(const std::string &path, const ColourImage &image);

// Black over blue, violet and orange to white for absolute errors of 0 to 0.5; the scale is fixed so that pictures
// compare. Not a number is green.
std::array<uint8_t, 3> heat_colour(float absolute_error);
// |a - b|; both of one size. Pixels where mask (may be null) is below 0.5 are dark grey.
ColourImage heat_map(const FloatImage &a, const FloatImage &b, const FloatImage *mask = nullptr);
// A visibility image in grey, linear values shown as they are.
ColourImage grey_image(const FloatImage &image);
