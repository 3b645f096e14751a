// How a figure grows along a sweep.
#pragma once

#include <optional>
#include <utility>
#include <vector>

// Least-squares slope of log y over log x: the exponent p of y ~ x^p. None for fewer than two positive points.
std::optional<double> growth_exponent(const std::vector<std::pair<double, double>> &points);
