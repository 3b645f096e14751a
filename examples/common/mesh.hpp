// Indexed triangle meshes: primitives, and files read by assimp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

struct Bounds {
    glm::dvec3 lower{0.0};
    glm::dvec3 upper{0.0};

    glm::dvec3 centre() const
    {
        return (lower + upper) * 0.5;
    }
    glm::dvec3 size() const
    {
        return upper - lower;
    }
};

struct Mesh {
    // One each per vertex. Colours are linear reflectances.
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec3> colours;
    std::vector<uint32_t> indices; // three per triangle

    size_t triangle_count() const
    {
        return indices.size() / 3;
    }
    Bounds bounds() const;
    // Adds the other mesh's triangles, transformed (an affine matrix).
    void append(const Mesh &other, const glm::dmat4 &transform = glm::dmat4(1.0));
};

// All primitives are centred on the origin and wound counter-clockwise seen from outside.
Mesh make_box(const glm::dvec3 &half_extents, const glm::vec3 &colour);
// `segments` around the y axis, `rings` from pole to pole: 2 * segments * rings triangles.
Mesh make_sphere(double radius, uint32_t segments, uint32_t rings, const glm::vec3 &colour);
// The parallelogram with half edges u and v, facing cross(u, v).
Mesh make_quad(const glm::dvec3 &half_u, const glm::dvec3 &half_v, const glm::vec3 &colour);
// Along the y axis, with caps.
Mesh make_cylinder(double radius, double half_height, uint32_t segments, const glm::vec3 &colour);

// Any file assimp reads (OBJ, glTF, PLY, ...): node transforms applied, all meshes joined, points and lines dropped.
// Missing textures do not matter. `colour` is used where the file gives none. Throws Error.
Mesh load_mesh(const std::string &path, const glm::vec3 &colour = glm::vec3(0.62f, 0.57f, 0.5f));
