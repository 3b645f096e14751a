// Turns a G-buffer and a visibility image into a picture.
#pragma once

#include "image_io.hpp"
#include "light.hpp"
#include "raster.hpp"

struct ShadeOptions {
    double exposure = 1.0;
    double ambient = 0.12; // of the light's brightness where it is aimed at
};

// Lambert shading by the light's centre times visibility, sky-like ambient light, a soft tone curve, sRGB. `camera`
// maps world to clip space; the picture is bright where the light is aimed at whatever its distance. `focus` is that
// place, and the floor fades into the background far away from it.
ColourImage shade(const GBufferPixels &pixels, const FloatImage &visibility, const Light &light, const Frustum &camera,
                  const glm::dvec3 &focus, const ShadeOptions &options = {});
