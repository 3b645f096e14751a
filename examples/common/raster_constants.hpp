// Push constants of shaders/*.vert and *.frag.
#pragma once

#include <glm/glm.hpp>

struct RasterConstants {
    glm::mat4 mesh_to_clip;
    glm::vec4 eye;
    float depth_sign;
    float depth_step;
};
static_assert(sizeof(RasterConstants) == 88, "must match the shaders");
