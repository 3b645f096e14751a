// One measured technique on one case: error, times, counts, memory, and how they are printed.
#pragma once

#include <optional>
#include <string>

#include "estimator.hpp"

// Over masked pixels that are shadowed in the truth or in the result (the metric of Atty et al. 2006).
struct ErrorMetric {
    double mae = 0, rmse = 0, p99 = 0, max = 0;
    uint64_t pixels = 0;
};
ErrorMetric measure_error(const FloatImage &result, const FloatImage &truth, const FloatImage *mask);

struct Row {
    std::string case_name, device, driver;
    Technique technique;
    uint32_t width = 0, height = 0, map_size = 0;
    double light_size = 0; // full edge in world units, or full angle in radians
    // Medians of the repetitions; passes of one name are summed.
    double build_ms = 0, visibility_ms = 0;
    std::vector<PassTime> passes;
    std::optional<softsh_stats> stats;
    std::optional<MemoryUse> memory;
    std::optional<ErrorMetric> error;
};

// Everything about the case and the device that a row carries.
Row make_row(const gpu &g, const Case &data, const Technique &technique);
// Medians over runs.
void add_times(Row &row, const std::vector<RunTimes> &runs);

// JSON with the fields of the tools' contract; figures that were not measured are null.
std::string to_json(const Row &row);
// One line for people.
std::string to_line(const Row &row);
