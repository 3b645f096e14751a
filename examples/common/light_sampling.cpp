#include "light_sampling.hpp"

#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>

// Shirley and Chiu, A low distortion map between disk and square, 1997: equal areas stay equal and stay compact, so a
// stratified square gives a stratified disc.
static glm::dvec2 square_to_disc(double s, double t)
{
    const double x = 2.0 * s - 1.0, y = 2.0 * t - 1.0;
    if (x == 0.0 && y == 0.0)
        return {0.0, 0.0};
    const double quarter = 0.25 * glm::pi<double>();
    const bool wide = std::fabs(x) > std::fabs(y);
    const double radius = wide ? x : y;
    const double angle = wide ? quarter * (y / x) : 2.0 * quarter - quarter * (x / y);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

// Two unit vectors perpendicular to n and to each other.
static void perpendicular(const glm::dvec3 &n, glm::dvec3 &a, glm::dvec3 &b)
{
    a = glm::normalize(glm::cross(n, std::fabs(n.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    b = glm::cross(n, a);
}

glm::dvec3 to_light_sample(const Light &light, const glm::dvec3 &p, double s, double t, double far_away)
{
    glm::dvec3 a, b;
    switch (light.shape) {
    case LightShape::rectangle:
        return light.centre + light.half_u * (2.0 * s - 1.0) + light.half_v * (2.0 * t - 1.0) - p;
    case LightShape::disc: {
        const glm::dvec2 d = square_to_disc(s, t);
        return light.centre + light.half_u * d.x + light.half_v * d.y - p;
    }
    case LightShape::sphere: {
        // The circle along which rays from p touch the sphere covers the same directions as the sphere.
        const glm::dvec3 axis = light.centre - p;
        const double distance2 = glm::dot(axis, axis);
        const double radius2 = glm::dot(light.half_u, light.half_u);
        if (!(distance2 > radius2))
            return glm::dvec3(0.0);
        const double share = 1.0 - radius2 / distance2;
        const double circle = std::sqrt(radius2 * share);
        const glm::dvec2 d = square_to_disc(s, t);
        perpendicular(axis / std::sqrt(distance2), a, b);
        return axis * share + (a * d.x + b * d.y) * circle;
    }
    case LightShape::directional:
        break;
    }
    const glm::dvec3 axis = -glm::normalize(light.direction);
    const glm::dvec2 d = square_to_disc(s, t) * std::tan(light.angular_radius);
    perpendicular(axis, a, b);
    return (axis + a * d.x + b * d.y) * far_away;
}

glm::dvec3 to_light_centre(const Light &light, const glm::dvec3 &p)
{
    return light.shape == LightShape::directional ? -glm::normalize(light.direction) : light.centre - p;
}

LightOutline light_outline(const Light &light, const glm::dvec3 &p, double far_away)
{
    switch (light.shape) {
    case LightShape::rectangle:
    case LightShape::disc:
        return {light.centre - p, light.half_u, light.half_v, light.shape == LightShape::disc};
    case LightShape::sphere: {
        LightOutline outline{glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(0.0), true};
        const glm::dvec3 axis = light.centre - p;
        const double distance2 = glm::dot(axis, axis);
        const double radius2 = glm::dot(light.half_u, light.half_u);
        if (!(distance2 > radius2))
            return outline;
        const double share = 1.0 - radius2 / distance2;
        const double circle = std::sqrt(radius2 * share);
        perpendicular(axis / std::sqrt(distance2), outline.half_u, outline.half_v);
        outline.centre = axis * share;
        outline.half_u *= circle;
        outline.half_v *= circle;
        return outline;
    }
    case LightShape::directional:
        break;
    }
    LightOutline outline{-glm::normalize(light.direction) * far_away, glm::dvec3(0.0), glm::dvec3(0.0), true};
    perpendicular(outline.centre / far_away, outline.half_u, outline.half_v);
    const double radius = std::tan(light.angular_radius) * far_away;
    outline.half_u *= radius;
    outline.half_v *= radius;
    return outline;
}

double highest_above(const LightOutline &outline, const glm::dvec3 &normal)
{
    const double u = std::fabs(glm::dot(outline.half_u, normal)), v = std::fabs(glm::dot(outline.half_v, normal));
    return glm::dot(outline.centre, normal) + (outline.round ? std::sqrt(u * u + v * v) : u + v);
}

uint32_t light_grid(uint32_t samples)
{
    return static_cast<uint32_t>(std::sqrt(static_cast<double>(samples)) + 1e-9);
}

std::vector<LightCell> light_cells(uint32_t grid)
{
    std::vector<LightCell> cells;
    for (uint32_t block_j = 0; block_j < grid; block_j += 4)
        for (uint32_t half_i = 0; half_i < grid; half_i += 2)
            for (uint32_t j = block_j; j < std::min(block_j + 4, grid); j++)
                for (uint32_t i = half_i; i < std::min(half_i + 2, grid); i++)
                    cells.push_back({i, j});
    return cells;
}
