// Mesh primitives.
#include "mesh.hpp"

#include <cmath>

#include <glm/gtc/constants.hpp>

Bounds Mesh::bounds() const
{
    if (positions.empty())
        return {};
    Bounds box{glm::dvec3(positions[0]), glm::dvec3(positions[0])};
    for (const glm::vec3 &p : positions) {
        box.lower = glm::min(box.lower, glm::dvec3(p));
        box.upper = glm::max(box.upper, glm::dvec3(p));
    }
    return box;
}

void Mesh::append(const Mesh &other, const glm::dmat4 &transform)
{
    const auto base = static_cast<uint32_t>(positions.size());
    const glm::dmat3 linear(transform);
    const glm::dmat3 normal_matrix = glm::transpose(glm::inverse(linear));
    const bool mirrors = glm::determinant(linear) < 0.0;

    for (size_t i = 0; i < other.positions.size(); i++) {
        positions.push_back(glm::vec3(transform * glm::dvec4(glm::dvec3(other.positions[i]), 1.0)));
        normals.push_back(glm::vec3(glm::normalize(normal_matrix * glm::dvec3(other.normals[i]))));
        colours.push_back(other.colours[i]);
    }
    for (size_t i = 0; i + 2 < other.indices.size(); i += 3) {
        indices.push_back(base + other.indices[i]);
        indices.push_back(base + other.indices[i + (mirrors ? 2 : 1)]);
        indices.push_back(base + other.indices[i + (mirrors ? 1 : 2)]);
    }
}

static void add_vertex(Mesh &mesh, const glm::dvec3 &position, const glm::dvec3 &normal, const glm::vec3 &colour)
{
    mesh.positions.push_back(glm::vec3(position));
    mesh.normals.push_back(glm::vec3(normal));
    mesh.colours.push_back(colour);
}

static void add_quad_indices(Mesh &mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
}

Mesh make_quad(const glm::dvec3 &half_u, const glm::dvec3 &half_v, const glm::vec3 &colour)
{
    const glm::dvec3 normal = glm::normalize(glm::cross(half_u, half_v));
    Mesh mesh;
    add_vertex(mesh, -half_u - half_v, normal, colour);
    add_vertex(mesh, half_u - half_v, normal, colour);
    add_vertex(mesh, half_u + half_v, normal, colour);
    add_vertex(mesh, -half_u + half_v, normal, colour);
    add_quad_indices(mesh, 0, 1, 2, 3);
    return mesh;
}

Mesh make_box(const glm::dvec3 &half_extents, const glm::vec3 &colour)
{
    Mesh mesh;
    for (int axis = 0; axis < 3; axis++)
        for (int side = -1; side <= 1; side += 2) {
            glm::dvec3 normal(0.0), u(0.0), v(0.0);
            normal[axis] = side;
            u[(axis + 1) % 3] = half_extents[(axis + 1) % 3] * side;
            v[(axis + 2) % 3] = half_extents[(axis + 2) % 3];
            const glm::dvec3 centre = normal * half_extents[axis];
            const auto base = static_cast<uint32_t>(mesh.positions.size());
            add_vertex(mesh, centre - u - v, normal, colour);
            add_vertex(mesh, centre + u - v, normal, colour);
            add_vertex(mesh, centre + u + v, normal, colour);
            add_vertex(mesh, centre - u + v, normal, colour);
            add_quad_indices(mesh, base, base + 1, base + 2, base + 3);
        }
    return mesh;
}

Mesh make_sphere(double radius, uint32_t segments, uint32_t rings, const glm::vec3 &colour)
{
    Mesh mesh;
    for (uint32_t r = 0; r <= rings; r++) {
        const double theta = glm::pi<double>() * r / rings;
        for (uint32_t s = 0; s <= segments; s++) {
            const double phi = 2.0 * glm::pi<double>() * s / segments;
            const glm::dvec3 n(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
            add_vertex(mesh, n * radius, n, colour);
        }
    }
    // The poles' quads have one edge of length zero, so one of their triangles is empty; it costs nothing.
    for (uint32_t r = 0; r < rings; r++)
        for (uint32_t s = 0; s < segments; s++) {
            const uint32_t a = r * (segments + 1) + s;
            add_quad_indices(mesh, a, a + 1, a + segments + 2, a + segments + 1);
        }
    return mesh;
}

Mesh make_cylinder(double radius, double half_height, uint32_t segments, const glm::vec3 &colour)
{
    Mesh mesh;
    for (uint32_t s = 0; s <= segments; s++) {
        const double phi = 2.0 * glm::pi<double>() * s / segments;
        const glm::dvec3 n(std::cos(phi), 0.0, std::sin(phi));
        add_vertex(mesh, n * radius + glm::dvec3(0, half_height, 0), n, colour);
        add_vertex(mesh, n * radius - glm::dvec3(0, half_height, 0), n, colour);
    }
    for (uint32_t s = 0; s < segments; s++)
        add_quad_indices(mesh, 2 * s, 2 * s + 2, 2 * s + 3, 2 * s + 1);
    for (int side = -1; side <= 1; side += 2) {
        const auto base = static_cast<uint32_t>(mesh.positions.size());
        add_vertex(mesh, {0, side * half_height, 0}, {0, side, 0}, colour);
        for (uint32_t s = 0; s <= segments; s++) {
            const double phi = -side * 2.0 * glm::pi<double>() * s / segments;
            add_vertex(mesh, {radius * std::cos(phi), side * half_height, radius * std::sin(phi)}, {0, side, 0},
                       colour);
        }
        for (uint32_t s = 0; s < segments; s++)
            mesh.indices.insert(mesh.indices.end(), {base, base + 1 + s, base + 2 + s});
    }
    return mesh;
}
