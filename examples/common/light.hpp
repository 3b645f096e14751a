// Lights, and the matrices of cameras and shadow maps, all in double precision. Matrices are column-major and map world
// to view (x right, y down, z forward) to Vulkan clip space (depth 0 to 1, or 1 to 0 when reversed).
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

enum class LightShape { rectangle, disc, sphere, directional };

struct Light {
    LightShape shape = LightShape::rectangle;
    glm::dvec3 centre{0.0}; // all but directional
    glm::dvec3 half_u{0.0}; // from the centre to the middle of an edge; for a sphere its length is the radius
    glm::dvec3 half_v{0.0};
    glm::dvec3 direction{0.0, -1.0, 0.0}; // directional: the way the light travels, unit length
    double angular_radius = 0.0;          // directional: half the angle of the sun's disc, radians
};

const char *light_shape_name(LightShape shape);

struct Frustum {
    glm::dmat4 view{1.0};
    glm::dmat4 projection{1.0};
    bool reversed = false; // near plane at depth 1, far plane at 0
};

// What projections have in common. far_plane may be infinity for perspective projections.
struct DepthRange {
    double near_plane = 0.1;
    double far_plane = 60.0;
    bool reversed = false;
};

glm::dmat4 look_at(const glm::dvec3 &eye, const glm::dvec3 &target, const glm::dvec3 &up);
// Angles in radians, aspect = width / height.
glm::dmat4 perspective(double fov_y, double aspect, const DepthRange &range);
glm::dmat4 orthographic(double half_width, double half_height, const DepthRange &range);

// A square perspective map along the light's normal: its projection centre is the light's centre, or `behind` world
// units behind it. The near and far planes stay `range` in front of the light. The light needs half_u and half_v that
// are not zero.
Frustum light_frustum(const Light &light, double fov, const DepthRange &range, double behind = 0.0);

// Orthographic, square, along a directional light; its axis runs through `centre`, `before` world units after the point
// that range counts from.
Frustum directional_frustum(const Light &light, const glm::dvec3 &centre, double half_width, const DepthRange &range,
                            double before);

// The part (i, j) of a rectangle split into grid x grid parts; (0, 0) is at -half_u, -half_v.
Light sub_light(const Light &light, uint32_t grid_u, uint32_t grid_v, uint32_t i, uint32_t j);

// A rectangle facing `target` with axes right and up as seen from the light, and half extents in world units.
Light rectangle_light(const glm::dvec3 &centre, const glm::dvec3 &target, const glm::dvec3 &up, double half_u,
                      double half_v);
