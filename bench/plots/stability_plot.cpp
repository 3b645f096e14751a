// Jumps under a moving light, and acne on tilted planes.
#include "stability_plot.hpp"

#include "bar_plot.hpp"
#include "names.hpp"
#include "sweep_plot.hpp"

namespace
{

std::optional<double> measure(const Row &row, const char *name)
{
    const auto found = row.measures.find(name);
    return found == row.measures.end() ? std::nullopt : std::optional<double>(found->second);
}

} // namespace

std::vector<Plot> stability_plots(const Report &report)
{
    Report acne("", "");
    BarChart jumps{"stability-motion",
                   "Light moved by one texel",
                   "largest change of visibility from one step to the next",
                   {},
                   {{"mean of the pixels that change", "#0072B2", {}}, {"99th percentile", "#E69F00", {}}},
                   std::nullopt};
    for (const Row &row : report.rows) {
        if (row.suite != "stability")
            continue;
        if (measure(row, "degrees") && row.technique.name != "copy")
            acne.rows.push_back(row);
        if (const auto mean = measure(row, "mean_largest_jump")) {
            jumps.groups.push_back(row.case_name + ": " + long_name(row.technique));
            jumps.series[0].values.push_back(mean);
            jumps.series[1].values.push_back(measure(row, "p99_largest_jump"));
        }
    }
    std::vector<Plot> plots;
    if (!jumps.groups.empty())
        plots.push_back(bar_plot(jumps));
    const Sweep sweep = {
        "stability",
        "Acne",
        "angle between normal and light, degrees",
        [](const Row &row) { return measure(row, "degrees"); },
        [](const Row &row) { return format("%g", measure(row, "degrees").value_or(0.0)); },
        "",
        {{"darkening of lit pixels, mean", [](const Row &row) { return measure(row, "mean_acne"); }, false},
         {"darkening of lit pixels, largest", [](const Row &row) { return measure(row, "largest_acne"); }, false}},
        false};
    for (Plot &plot : sweep_plots_of(sweep, acne))
        plots.push_back(std::move(plot));
    return plots;
}
