// Between scene_list.cpp, which describes scenes, and scene.cpp, which applies the options to them.
#pragma once

#include "scene.hpp"

struct SceneSetup {
    std::string name;
    Mesh objects; // what casts shadows
    Mesh floor;
    Camera camera;
    glm::dvec3 light_centre{0.0};
    glm::dvec3 light_target{0.0};
    glm::dvec3 light_up{0.0, 0.0, 1.0};
    double light_half_u = 0.8;
    double light_half_v = 0.8;
    double map_fov = 0.0;
    DepthRange map_range{1.0, 30.0, false};
    uint32_t map_size = 1024;
};

Scene finish_scene(const SceneSetup &setup, const SceneOptions &options);
