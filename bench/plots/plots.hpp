// Plots of what a run of the benchmark found.
#pragma once

#include <string>

#include "report.hpp"

// An SVG and a PNG of every plot for which the report has rows, and the gnuplot script that drew them, into `folder`,
// which exists. Throws Error.
void write_plots(const Report &report, const std::string &folder);
