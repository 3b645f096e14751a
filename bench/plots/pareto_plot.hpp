// Error against time, all techniques of a case in one plot.
#pragma once

#include <vector>

#include "gnuplot.hpp"
#include "report.hpp"

std::vector<Plot> pareto_plots(const Report &report);
