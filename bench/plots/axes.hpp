// Axes: ranges and tics.
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

// Grows with every value it is shown.
struct Range {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    void show(double value)
    {
        low = value < low ? value : low;
        high = value > high ? value : high;
    }
    bool empty() const
    {
        return !(low <= high);
    }
};

// Room on both sides of a logarithmic axis, at least half a decade in all.
Range widened(const Range &range, double factor);

// "set logscale x" with range and tics at 1, 2 and 5 times powers of ten; for axis 'x' or 'y'.
std::string log_axis(char axis, const Range &range);

using Tics = std::vector<std::pair<std::string, double>>; // text and place
std::string tics(char axis, const Tics &tics);

// Borders, grid and fonts that all plots share.
extern const char *const common_axes;
