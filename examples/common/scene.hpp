// The scenes of the examples, the tests and the benchmark: a mesh, a camera, a light and the light's map.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "light.hpp"
#include "mesh.hpp"

struct SceneOptions {
    // Full edge of a square light in world units, replacing the scene's own; 0 makes it a point. With `directional` it
    // sets the angular radius under which that light would appear from the scene.
    std::optional<double> light_size;

    bool directional = false;                  // a sun instead of the rectangle, with an orthographic map
    std::optional<glm::dvec3> light_direction; // default: from the scene's light to what it is aimed at
    std::optional<double> angular_radius;      // radians; default: as large as the scene's light appears

    double map_behind = 0.0; // world units from the light back to the map's projection centre

    bool reversed_camera = false;
    bool infinite_camera = false;
    bool reversed_map = false;
    bool infinite_map = false; // perspective maps only

    // Moves everything, as in a large world. The mesh keeps its small coordinates: see Scene::origin.
    glm::dvec3 world_offset{0.0};
};

struct Camera {
    glm::dvec3 eye{0.0};
    glm::dvec3 target{0.0};
    glm::dvec3 up{0.0, 1.0, 0.0};
    double fov_y = 0.0;
    DepthRange range;
};

struct Scene {
    std::string name;
    Mesh mesh;
    glm::dvec3 origin{0.0}; // world position of the mesh's zero; all else here is in world space
    Camera camera;
    Light light;
    Frustum map;
    double map_fov = 0.0; // radians; perspective maps
    DepthRange map_range; // in front of the light; perspective maps
    double map_behind = 0.0;
    uint32_t map_size = 1024; // recommended edge in texels
};

// Names make_scene knows, with one line about each.
struct SceneName {
    const char *name;
    const char *about;
};
const std::vector<SceneName> &scene_names();

// Throws Error for an unknown name or an option out of range.
Scene make_scene(const std::string &name, const SceneOptions &options = {});
// A mesh file, scaled to a largest extent of 2.8 and set on a floor.
Scene make_model_scene(const std::string &path, const SceneOptions &options = {});

// Puts the scene's rectangular light, and the map with it, elsewhere; `up` as for rectangle_light.
void place_light(Scene &scene, const glm::dvec3 &centre, const glm::dvec3 &target, const glm::dvec3 &up);

Frustum camera_frustum(const Scene &scene, uint32_t width, uint32_t height);
// The map of part (i, j) of the scene's rectangular light, split into grid x grid parts.
Frustum sub_light_frustum(const Scene &scene, uint32_t grid, uint32_t i, uint32_t j);
