#include "light.hpp"

#include <cmath>

const char *light_shape_name(LightShape shape)
{
    switch (shape) {
    case LightShape::rectangle:
        return "rectangle";
    case LightShape::disc:
        return "disc";
    case LightShape::sphere:
        return "sphere";
    case LightShape::directional:
        break;
    }
    return "directional";
}

// Rows right, down, forward.
static glm::dmat4 view_matrix(const glm::dvec3 &eye, const glm::dvec3 &right, const glm::dvec3 &down,
                              const glm::dvec3 &forward)
{
    const glm::dmat3 rotation = glm::transpose(glm::dmat3(right, down, forward));
    glm::dmat4 view(rotation);
    view[3] = glm::dvec4(-(rotation * eye), 1.0);
    return view;
}

glm::dmat4 look_at(const glm::dvec3 &eye, const glm::dvec3 &target, const glm::dvec3 &up)
{
    const glm::dvec3 forward = glm::normalize(target - eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, up));
    return view_matrix(eye, right, glm::cross(forward, right), forward);
}

glm::dmat4 perspective(double fov_y, double aspect, const DepthRange &range)
{
    const double n = range.near_plane;
    const double f = range.far_plane;
    const double y = 1.0 / std::tan(fov_y * 0.5);
    // depth = a + b / z
    double a = std::isinf(f) ? 1.0 : f / (f - n);
    double b = std::isinf(f) ? -n : -n * f / (f - n);
    if (range.reversed) {
        a = 1.0 - a;
        b = -b;
    }
    glm::dmat4 m(0.0);
    m[0][0] = y / aspect;
    m[1][1] = y;
    m[2][2] = a;
    m[2][3] = 1.0;
    m[3][2] = b;
    return m;
}

glm::dmat4 orthographic(double half_width, double half_height, const DepthRange &range)
{
    const double length = range.far_plane - range.near_plane;
    glm::dmat4 m(1.0);
    m[0][0] = 1.0 / half_width;
    m[1][1] = 1.0 / half_height;
    m[2][2] = (range.reversed ? -1.0 : 1.0) / length;
    m[3][2] = (range.reversed ? range.far_plane : -range.near_plane) / length;
    return m;
}

Frustum light_frustum(const Light &light, double fov, const DepthRange &range, double behind)
{
    const glm::dvec3 right = glm::normalize(light.half_u);
    const glm::dvec3 down = -glm::normalize(light.half_v);
    const glm::dvec3 forward = glm::cross(right, down);
    DepthRange moved = range;
    moved.near_plane += behind;
    moved.far_plane += behind;
    return {view_matrix(light.centre - forward * behind, right, down, forward), perspective(fov, 1.0, moved),
            range.reversed};
}

Frustum directional_frustum(const Light &light, const glm::dvec3 &centre, double half_width, const DepthRange &range,
                            double before)
{
    const glm::dvec3 forward = glm::normalize(light.direction);
    const glm::dvec3 up = std::fabs(forward.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
    const glm::dmat4 view = look_at(centre - forward * before, centre, up);
    return {view, orthographic(half_width, half_width, range), range.reversed};
}

Light sub_light(const Light &light, uint32_t grid_u, uint32_t grid_v, uint32_t i, uint32_t j)
{
    Light part = light;
    part.half_u = light.half_u / static_cast<double>(grid_u);
    part.half_v = light.half_v / static_cast<double>(grid_v);
    part.centre = light.centre + light.half_u * ((2.0 * i + 1.0) / grid_u - 1.0) +
                  light.half_v * ((2.0 * j + 1.0) / grid_v - 1.0);
    return part;
}

Light rectangle_light(const glm::dvec3 &centre, const glm::dvec3 &target, const glm::dvec3 &up, double half_u,
                      double half_v)
{
    const glm::dvec3 forward = glm::normalize(target - centre);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, up));
    Light light;
    light.centre = centre;
    light.half_u = right * half_u;
    light.half_v = glm::cross(right, forward) * half_v;
    return light;
}
