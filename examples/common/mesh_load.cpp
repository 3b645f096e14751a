// Mesh files, read by assimp.
#include "mesh.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <assimp/Importer.hpp>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "error.hpp"

static bool is_finite(const aiVector3D &v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// assimp's messages may span lines.
static std::string one_line(std::string text)
{
    for (char &c : text)
        if (c == '\n' || c == '\r')
            c = ' ';
    return text.substr(0, 300);
}

static glm::vec3 material_colour(const aiScene &scene, const aiMesh &part, const glm::vec3 &fallback)
{
    aiColor4D colour;
    int textures = 0;
    if (part.mMaterialIndex >= scene.mNumMaterials)
        return fallback;
    const aiMaterial &material = *scene.mMaterials[part.mMaterialIndex];
    textures += static_cast<int>(material.GetTextureCount(aiTextureType_DIFFUSE));
    textures += static_cast<int>(material.GetTextureCount(aiTextureType_BASE_COLOR));
    // assimp's stand-in where the file has no material.
    if (std::string(material.GetName().C_Str()) == AI_DEFAULT_MATERIAL_NAME)
        return fallback;
    // The factor of a textured material is white and says nothing.
    if (textures > 0 || aiGetMaterialColor(&material, AI_MATKEY_COLOR_DIFFUSE, &colour) != AI_SUCCESS)
        return fallback;
    const glm::vec3 rgb(colour.r, colour.g, colour.b);
    const bool finite = std::isfinite(rgb.r) && std::isfinite(rgb.g) && std::isfinite(rgb.b);
    return finite ? glm::clamp(rgb, 0.05f, 0.9f) : fallback;
}

static void append_part(Mesh &mesh, const aiScene &scene, const aiMesh &part, const std::string &path,
                        const glm::vec3 &fallback)
{
    const size_t base = mesh.positions.size();
    const glm::vec3 colour = material_colour(scene, part, fallback);

    if (base + part.mNumVertices > UINT32_MAX)
        fail("%s: more vertices than 32-bit indices can address", path.c_str());
    for (unsigned i = 0; i < part.mNumVertices; i++) {
        const aiVector3D &p = part.mVertices[i];
        aiVector3D n = part.HasNormals() ? part.mNormals[i] : aiVector3D(0, 1, 0);
        if (!is_finite(p))
            fail("%s: vertex %zu is not finite", path.c_str(), base + i);
        if (!is_finite(n) || n.SquareLength() < 1e-12f)
            n = aiVector3D(0, 1, 0); // unused vertices and empty triangles have no normal
        n.Normalize();
        mesh.positions.emplace_back(p.x, p.y, p.z);
        mesh.normals.emplace_back(n.x, n.y, n.z);
        mesh.colours.push_back(colour);
    }
    for (unsigned f = 0; f < part.mNumFaces; f++) {
        const aiFace &face = part.mFaces[f];
        if (face.mNumIndices != 3)
            continue;
        for (unsigned k = 0; k < 3; k++) {
            if (face.mIndices[k] >= part.mNumVertices)
                fail("%s: face %u refers to vertex %u of %u", path.c_str(), f, face.mIndices[k], part.mNumVertices);
            mesh.indices.push_back(static_cast<uint32_t>(base + face.mIndices[k]));
        }
    }
}

// assimp 5.2 never returns from a PLY file that ends inside its header.
static void check_ply_header(const std::string &path)
{
    if (path.size() < 4 || path.compare(path.size() - 4, 4, ".ply") != 0)
        return;
    std::ifstream file(path, std::ios::binary);
    if (!file)
        return; // assimp says so
    std::string header(65536, '\0');
    file.read(header.data(), static_cast<std::streamsize>(header.size()));
    header.resize(static_cast<size_t>(file.gcount()));
    if (header.find("end_header") == std::string::npos)
        fail("%s: the PLY header has no end_header, the file is truncated", path.c_str());
}

Mesh load_mesh(const std::string &path, const glm::vec3 &colour)
{
    check_ply_header(path);
    std::error_code code;
    if (!std::filesystem::is_regular_file(path, code) || !std::ifstream(path))
        fail("%s: cannot open, expected a readable mesh file", path.c_str());

    Assimp::Importer importer;
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, 60.0f);
    const unsigned steps = aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_GenSmoothNormals |
                           aiProcess_JoinIdenticalVertices | aiProcess_PreTransformVertices;
    const aiScene *scene = importer.ReadFile(path, steps);
    if (!scene)
        fail("%s: cannot be read as a mesh: %s", path.c_str(), one_line(importer.GetErrorString()).c_str());
    if (scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE)
        fail("%s: incomplete mesh file", path.c_str());

    Mesh mesh;
    for (unsigned i = 0; i < scene->mNumMeshes; i++)
        append_part(mesh, *scene, *scene->mMeshes[i], path, colour);
    if (mesh.indices.empty())
        fail("%s: contains no triangles", path.c_str());
    return mesh;
}
