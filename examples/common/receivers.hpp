// The surfaces that a camera's depth buffer shows, as points to cast shadow rays from: what a ray tracer that has
// rendered the camera's view knows, recovered from the depth buffer and the mesh.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "case_io.hpp"
#include "mesh.hpp"
#include "ray_scene.hpp"

// In mesh space, where coordinates are small.
struct Receiver {
    glm::dvec3 position;
    glm::dvec3 normal; // of the triangle, towards the viewer
    double offset;     // how far to leave the surface so as not to hit it
    uint32_t pixel;    // y * width + x
};

struct Receivers {
    uint32_t width = 0, height = 0; // of the picture
    glm::dvec3 origin{0.0};         // world position of mesh space's zero
    double reach = 0.0;             // a segment of this length leaves the scene from everywhere in it
    std::vector<Receiver> points;   // of the pixels that are not background, row by row
};

// `rays` holds `mesh`, whose zero lies at `origin`; the camera's matrices map world to clip space.
Receivers find_receivers(const Mesh &mesh, const RayScene &rays, const glm::dvec3 &origin, const DepthView &camera);
