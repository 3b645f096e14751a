// What the library costs where there is nothing to do: times over that of a pass that reads the depth and writes 1.
#include "skip_plot.hpp"

#include <algorithm>
#include <map>

#include "bar_plot.hpp"
#include "names.hpp"

std::vector<Plot> skip_plots(const Report &report)
{
    std::map<std::string, const Row *> copy; // by variant
    for (const Row &row : report.rows)
        if (row.suite == "skip" && row.technique.name == "copy" && row.times && row.times->total > 0.0)
            copy[row.variant] = &row;
    BarChart chart{"skip", "Nothing to do", "time over that of a copy pass", {}, {}, 1.0};
    const auto add = [&](const std::string &title, const std::string &colour, const std::string &variant,
                         double value) {
        auto &groups = chart.groups;
        if (std::find(groups.begin(), groups.end(), variant) == groups.end()) {
            groups.push_back(variant);
            for (BarSeries &series : chart.series)
                series.values.emplace_back();
        }
        auto series = std::find_if(chart.series.begin(), chart.series.end(),
                                   [&](const BarSeries &s) { return s.title == title; });
        if (series == chart.series.end())
            series = chart.series.insert(chart.series.end(), {title, colour, {}});
        series->values.resize(groups.size());
        series->values[static_cast<size_t>(std::find(groups.begin(), groups.end(), variant) - groups.begin())] = value;
    };
    for (const Row &row : report.rows) {
        if (row.suite != "skip" || !row.times || row.technique.name == "copy" || !copy.count(row.variant))
            continue;
        const RowTimes &floor = *copy[row.variant]->times;
        const std::string name = long_name(row.technique);
        const std::string colour = look_of(row.technique.name).colour;
        add(name, colour, row.variant, row.times->visibility / floor.visibility);
        if (row.times->build > 0.0)
            add(name + ", with the build", "#F0B58A", row.variant, row.times->total / floor.total);
    }
    if (chart.series.empty())
        return {};
    return {bar_plot(chart)};
}
