// Horizontal bars in groups.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gnuplot.hpp"

struct BarSeries {
    std::string title, colour;
    std::vector<std::optional<double>> values; // one per group
};

struct BarChart {
    std::string name, title, label;
    std::vector<std::string> groups; // from the top
    std::vector<BarSeries> series;
    std::optional<double> mark; // a line across all bars
};

Plot bar_plot(const BarChart &chart);
