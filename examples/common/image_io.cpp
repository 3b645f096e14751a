#include "image_io.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <OpenImageIO/imageio.h>

#include "error.hpp"

static std::string one_line(std::string text)
{
    for (char &c : text)
        if (c == '\n' || c == '\r')
            c = ' ';
    return text.substr(0, 300);
}

FloatImage read_exr(const std::string &path)
{
    std::error_code code;
    if (!std::filesystem::is_regular_file(path, code))
        fail("%s: no such file, expected a single-channel EXR", path.c_str());
    auto input = OIIO::ImageInput::open(path);
    if (!input)
        fail("%s: not a readable EXR: %s", path.c_str(), one_line(OIIO::geterror()).c_str());
    const OIIO::ImageSpec &spec = input->spec();
    if (std::string(input->format_name()) != "openexr")
        fail("%s: is %s, expected a single-channel EXR", path.c_str(), input->format_name());
    if (spec.deep || spec.nchannels != 1)
        fail("%s: has %d channels, expected 1", path.c_str(), spec.nchannels);
    if (spec.width < 1 || spec.height < 1 || spec.width > static_cast<int>(max_image_size) ||
        spec.height > static_cast<int>(max_image_size))
        fail("%s: size %dx%d, expected 1 to %u", path.c_str(), spec.width, spec.height, max_image_size);
    FloatImage image(static_cast<uint32_t>(spec.width), static_cast<uint32_t>(spec.height));
    if (!input->read_image(0, 0, 0, 1, OIIO::TypeDesc::FLOAT, image.texels.data()))
        fail("%s: truncated or damaged: %s", path.c_str(), one_line(input->geterror()).c_str());
    input->close();
    return image;
}

static void write_image(const std::string &path, const OIIO::ImageSpec &spec, OIIO::TypeDesc type, const void *texels)
{
    auto output = OIIO::ImageOutput::create(path);
    if (!output)
        fail("%s: cannot write this kind of image, expected .exr or .png", path.c_str());
    if (!output->open(path, spec) || !output->write_image(type, texels) || !output->close())
        fail("%s: cannot be written: %s", path.c_str(), one_line(output->geterror()).c_str());
}

void write_exr(const std::string &path, const FloatImage &image)
{
    OIIO::ImageSpec spec(static_cast<int>(image.width), static_cast<int>(image.height), 1, OIIO::TypeDesc::FLOAT);
    spec.channelnames = {"Y"};
    spec.attribute("compression", "zip");
    write_image(path, spec, OIIO::TypeDesc::FLOAT, image.texels.data());
}

void write_png(const std::string &path, const ColourImage &image)
{
    const OIIO::ImageSpec spec(static_cast<int>(image.width), static_cast<int>(image.height), 3, OIIO::TypeDesc::UINT8);
    write_image(path, spec, OIIO::TypeDesc::UINT8, image.rgb.data());
}

std::array<uint8_t, 3> heat_colour(float absolute_error)
{
    static const float stops[6][3] = {{0, 0, 4},     {66, 10, 104},  {147, 38, 103},
                                      {221, 81, 58}, {252, 165, 10}, {252, 255, 220}};
    if (std::isnan(absolute_error))
        return {0, 255, 0};
    const float t = std::clamp(absolute_error / 0.5f, 0.0f, 1.0f) * 5.0f;
    const int i = std::min(static_cast<int>(t), 4);
    const float f = t - static_cast<float>(i);
    std::array<uint8_t, 3> colour{};
    for (size_t c = 0; c < 3; c++)
        colour[c] = static_cast<uint8_t>(std::lround(stops[i][c] + (stops[i + 1][c] - stops[i][c]) * f));
    return colour;
}

ColourImage heat_map(const FloatImage &a, const FloatImage &b, const FloatImage *mask)
{
    if (a.width != b.width || a.height != b.height || (mask && (mask->width != a.width || mask->height != a.height)))
        fail("heat map of images of different sizes: %ux%u and %ux%u", a.width, a.height, b.width, b.height);
    ColourImage out(a.width, a.height);
    for (size_t i = 0; i < a.texels.size(); i++) {
        std::array<uint8_t, 3> colour = heat_colour(std::fabs(a.texels[i] - b.texels[i]));
        if (mask && !(mask->texels[i] >= 0.5f))
            colour = {40, 40, 44};
        std::copy(colour.begin(), colour.end(), out.rgb.begin() + static_cast<std::ptrdiff_t>(i * 3));
    }
    return out;
}

ColourImage grey_image(const FloatImage &image)
{
    ColourImage out(image.width, image.height);
    for (size_t i = 0; i < image.texels.size(); i++) {
        const float v = image.texels[i];
        const auto grey = static_cast<uint8_t>(std::lround(255.0f * (v >= 0.0f ? std::min(v, 1.0f) : 0.0f)));
        std::fill_n(out.rgb.begin() + static_cast<std::ptrdiff_t>(i * 3), 3, grey);
    }
    return out;
}
