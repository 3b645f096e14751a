// What --technique and --set say: one technique, of the library or a peer, with its settings.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <softshadow/softshadow.h>

#include "peers.h"

// What runs a technique.
enum class TechniqueKind {
    library,
    dispatch, // one dispatch of bench/peers on the depth buffers of the case
    average,  // a shadow map of the scene's mesh for each of many points of the light
    embree,   // shadow rays on the CPU through the scene's mesh
};

struct Technique {
    std::string name;                            // as given
    std::map<std::string, std::string> settings; // as given, for reports
    TechniqueKind kind = TechniqueKind::library;
    peer_kind peer = PEER_KIND_COUNT;
    peer_settings peer_options{};
    bool fit_near = false;     // a peer knows the nearest depth of the map
    bool automatic = false;    // the library without settings
    softsh_settings library{}; // unless automatic
    softsh_accel accel = SOFTSH_ACCEL_AUTO;
    bool reuse = false;             // one structure for all sub-lights, built again before each
    uint32_t rays = 64;             // embree: of a pixel, rounded down to a square number
    std::optional<uint32_t> layers; // use only the first N layer maps
};

// `assignments` are "key=value". Throws Error that lists what is valid.
Technique parse_technique(const std::string &name, const std::vector<std::string> &assignments);

// "bitmask primitive=microquad budget=16" and the like.
std::string describe(const Technique &technique);

// For --help: techniques and settings, one per line.
std::string technique_help();
