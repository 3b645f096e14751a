// Jumps under a moving light, and acne on tilted planes.
#pragma once

#include <vector>

#include "gnuplot.hpp"
#include "report.hpp"

std::vector<Plot> stability_plots(const Report &report);
