#include "shade.hpp"

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "light_sampling.hpp"

// A filmic curve (Hable 2010's idea in Narkowicz's fit): steep in the shadows, soft shoulder, so that lit floors keep
// their texture and umbrae their detail.
static double tone(double x)
{
    return std::clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

static double srgb(double x)
{
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
}

static glm::dvec3 background(double height)
{
    const glm::dvec3 low(0.34, 0.36, 0.38), high(0.16, 0.21, 0.28);
    return glm::mix(low, high, std::clamp(height, 0.0, 1.0));
}

// 1 near the focus, 0 far from it.
static double presence(const glm::dvec3 &p, const glm::dvec3 &focus)
{
    const double distance = glm::length(glm::dvec2(p.x - focus.x, p.z - focus.z));
    const double t = std::clamp((distance - 7.5) / 4.5, 0.0, 1.0);
    return 1.0 - t * t * (3.0 - 2.0 * t);
}

ColourImage shade(const GBufferPixels &pixels, const FloatImage &visibility, const Light &light, const Frustum &camera,
                  const glm::dvec3 &focus, const ShadeOptions &options)
{
    const FloatImage &depth = pixels.depth;
    if (visibility.width != depth.width || visibility.height != depth.height)
        fail("shading: visibility is %ux%u, the G-buffer %ux%u", visibility.width, visibility.height, depth.width,
             depth.height);
    const glm::dmat4 to_world = glm::inverse(camera.projection * camera.view);
    const float nothing = camera.reversed ? 0.0f : 1.0f;
    const glm::dvec3 aim = to_light_centre(light, focus);
    const double reference = glm::dot(aim, aim);
    const glm::dvec3 sun(1.05, 1.0, 0.92);
    ColourImage out(depth.width, depth.height);

    for (uint32_t y = 0; y < depth.height; y++)
        for (uint32_t x = 0; x < depth.width; x++) {
            const size_t i = static_cast<size_t>(y) * depth.width + x;
            const glm::dvec3 sky = background(1.0 - (y + 0.5) / depth.height);
            glm::dvec3 colour = sky;
            if (depth.texels[i] != nothing) {
                const glm::dvec4 q = to_world * glm::dvec4(2.0 * (x + 0.5) / depth.width - 1.0,
                                                           2.0 * (y + 0.5) / depth.height - 1.0, depth.texels[i], 1.0);
                const glm::dvec3 p = glm::dvec3(q) / q.w;
                const glm::dvec3 normal(pixels.normal[i]);
                const glm::dvec3 to_light = to_light_centre(light, p);
                const double distance2 = glm::dot(to_light, to_light);
                // Half of the physical falloff (a power of one instead of two): wide floors stay readable.
                const double falloff = std::sqrt(reference / distance2);
                const double lambert = std::max(0.0, glm::dot(normal, to_light) / std::sqrt(distance2));
                const double seen = std::clamp(static_cast<double>(visibility.texels[i]), 0.0, 1.0);
                const glm::dvec3 above(0.78, 0.9, 1.12), below(0.5, 0.45, 0.4);
                const glm::dvec3 ambient = glm::mix(below, above, 0.5 + 0.5 * normal.y) * options.ambient;
                const glm::dvec3 lit =
                    glm::dvec3(pixels.albedo[i]) * (sun * (0.72 * lambert * falloff * seen) + ambient);
                colour = glm::mix(sky, lit, presence(p, focus));
            }
            for (int c = 0; c < 3; c++)
                out.rgb[i * 3 + static_cast<size_t>(c)] =
                    static_cast<uint8_t>(std::lround(255.0 * srgb(tone(colour[c] * options.exposure))));
        }
    return out;
}
