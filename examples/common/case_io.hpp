// The case format: a folder with case.json and EXR files, depth buffers with their matrices and perhaps a truth.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "image_io.hpp"
#include "light.hpp"

enum class MapRole { layer, sublight, face, cascade };

const char *map_role_name(MapRole role);

// A depth buffer and how it was projected; frustum.reversed is its depth convention.
struct DepthView {
    FloatImage depth;
    Frustum frustum;
};

struct CaseMap : DepthView {
    MapRole role = MapRole::layer;
    uint32_t index = 0;        // all roles but sublight
    uint32_t grid[2] = {1, 1}; // sublight: parts along half_u and half_v, and which one this is
    uint32_t cell[2] = {0, 0};
};

struct Case {
    std::string name; // of the folder
    DepthView camera;
    Light light;
    std::vector<CaseMap> maps;
    std::optional<FloatImage> truth;  // visible fraction of the light per camera pixel
    std::optional<FloatImage> mask;   // 1 where a pixel is a receiver facing the light
    uint32_t truth_light_samples = 0; // 0: not known
    uint32_t triangles = 0;           // 0: not known
};

// Checks every field. Throws Error, one line naming file and field and what was expected.
Case load_case(const std::string &folder);
// Creates the folder if needed and writes case.json last, so that a folder with one is complete.
void save_case(const std::string &folder, const Case &data);
