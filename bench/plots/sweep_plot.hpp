// Figures over what a suite varies, one line per technique.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "axes.hpp"
#include "gnuplot.hpp"
#include "report.hpp"

struct SweepPanel {
    const char *label; // of the vertical axis
    std::function<std::optional<double>(const Row &)> value;
    bool logarithmic = true;
};

struct Sweep {
    const char *suite;
    const char *title;
    const char *label; // of the horizontal axis
    std::function<std::optional<double>(const Row &)> place;
    std::function<std::string(const Row &)> tic;            // the text at a place
    const char *setting;                                    // that is varied, and tells no lines apart; or empty
    std::vector<SweepPanel> panels;                         // up to three
    bool logarithmic = true;                                // the horizontal axis
    std::function<std::string(const Row &)> line = nullptr; // the name of a row's line, in place of its technique's
};

// One plot per case of the suite.
std::vector<Plot> sweep_plots_of(const Sweep &sweep, const Report &report);

// Light size, resolution, map size, budget and build.
std::vector<Plot> sweep_plots(const Report &report);
