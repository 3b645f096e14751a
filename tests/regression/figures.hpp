// The figures under regression: what fixed settings count, allocate and get wrong on fixed scenes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gpu.h"
#include "progress.hpp"

// By scene, technique and name of the figure.
template <class T>
using FigureTable = std::map<std::string, std::map<std::string, std::map<std::string, T>>>;

// What is measured: every technique on every scene.
struct Selection {
    std::vector<std::string> scenes, techniques;
};
Selection all_figures();

// Ground truth is kept in `cache_folder` unless that is empty. Throws Error.
FigureTable<double> measure_figures(gpu &g, const Selection &selection, const std::string &cache_folder,
                                    Progress &progress);
