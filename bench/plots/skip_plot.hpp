// What the library costs where there is nothing to do.
#pragma once

#include <vector>

#include "gnuplot.hpp"
#include "report.hpp"

std::vector<Plot> skip_plots(const Report &report);
