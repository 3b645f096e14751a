// One measured technique on one case: error, times, counts, memory, and how they are printed.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "estimator.hpp"

// Over masked pixels that are shadowed in the truth or in the result (the metric of Atty et al. 2006).
struct ErrorMetric {
    double mae = 0, rmse = 0, p99 = 0, max = 0;
    uint64_t pixels = 0;
};
ErrorMetric measure_error(const FloatImage &result, const FloatImage &truth, const FloatImage *mask);

// Of several runs, milliseconds.
struct RowTimes {
    uint32_t runs = 0;
    double build = 0, visibility = 0;     // medians; the device's time
    double total = 0;                     // median of the sums
    double total_low = 0, total_high = 0; // quartiles of the sums
    double wall = 0;                      // median; recording, submitting and waiting as the host saw it
    std::vector<PassTime> passes;         // medians; passes of one name are summed
};

struct Row {
    std::string case_name, device, driver;
    std::string suite, variant; // of the benchmark, and what it changed in the case; or empty
    Technique technique;
    uint32_t width = 0, height = 0, map_size = 0;
    double light_size = 0; // full edge in world units, or full angle in radians
    std::optional<RowTimes> times;
    std::optional<softsh_stats> stats;
    std::optional<MemoryUse> memory;
    std::optional<ErrorMetric> error;
    std::optional<bool> front;              // on the Pareto front of its case
    std::map<std::string, double> measures; // further figures of a suite
};

// Everything about the case and the device that a row carries.
Row make_row(const gpu &g, const Case &data, const Technique &technique);
// Medians over runs; none if there are no runs.
std::optional<RowTimes> summarise(const std::vector<RunTimes> &runs);

// Milliseconds of a stage ("build", "classify", "evaluate", "filter"); none if no pass of it ran.
std::optional<double> stage_ms(const Row &row, const std::string &stage);

// JSON with the fields of the tools' contract; figures that were not measured are null.
std::string to_json(const Row &row);
// The fields of the JSON row, flattened; settings as "key=value key=value".
std::string csv_header();
std::string to_csv(const Row &row);
// One line for people.
std::string to_line(const Row &row);
