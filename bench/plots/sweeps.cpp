// The plots of the suites that vary one thing.
#include <algorithm>
#include <cstdlib>

#include "names.hpp"
#include "sweep_plot.hpp"

namespace
{

using Value = std::optional<double>;

Value time_without_build(const Row &row)
{
    return row.times ? Value(row.times->visibility) : std::nullopt;
}

Value time(const Row &row)
{
    return row.times ? Value(row.times->total) : std::nullopt;
}

Value build_time(const Row &row)
{
    return row.times ? Value(row.times->build) : std::nullopt;
}

// The copy pass draws no shadow: its error says nothing.
Value error(const Row &row)
{
    return row.error && row.technique.name != "copy" ? Value(row.error->mae) : std::nullopt;
}

Value primitives(const Row &row)
{
    return row.stats && row.stats->active ? Value(double(row.stats->primitives) / double(row.stats->active))
                                          : std::nullopt;
}

Value mebibytes(const Row &row)
{
    return row.memory ? Value(double(row.memory->persistent) / 1048576.0) : std::nullopt;
}

Value map_size(const Row &row)
{
    return row.map_size;
}

std::string map_tic(const Row &row)
{
    return std::to_string(row.map_size);
}

// None for techniques without one.
Value budget(const Row &row)
{
    const auto found = row.technique.settings.find("budget");
    if (found == row.technique.settings.end())
        return std::nullopt;
    return found->second == "inf" ? std::numeric_limits<double>::infinity() : std::atof(found->second.c_str());
}

std::string budget_tic(const Row &row)
{
    const std::string value = row.technique.settings.at("budget");
    return value == "inf" ? "\u221e" : value;
}

std::string accel_line(const Row &row)
{
    const auto found = row.technique.settings.find("accel");
    if (found == row.technique.settings.end())
        return long_name(row.technique);
    std::string name = found->second;
    std::transform(name.begin(), name.end(), name.begin(), [](char c) { return c >= 'a' ? char(c - 32) : c; });
    return name;
}

const SweepPanel time_panel = {"time with the build, ms", time};
const SweepPanel error_panel = {"error", error};
const SweepPanel primitive_panel = {"primitives per active pixel", primitives};

} // namespace

std::vector<Plot> sweep_plots(const Report &report)
{
    const Sweep sweeps[] = {
        {"light-size",
         "Size of the light",
         "width of the light, world units",
         [](const Row &row) { return Value(row.light_size); },
         [](const Row &row) { return format("%.3g", row.light_size); },
         "",
         {{"time without the build, ms", time_without_build}, primitive_panel, error_panel}},
        {"resolution",
         "Size of the picture",
         "pixels",
         [](const Row &row) { return Value(double(row.width) * row.height); },
         [](const Row &row) { return format("%ux%u", row.width, row.height); },
         "",
         {time_panel}},
        {"map-size",
         "Size of the map",
         "edge of the map, texels",
         map_size,
         map_tic,
         "",
         {time_panel, error_panel, {"memory of the light, MiB", mebibytes}}},
        {"budget",
         "Budget",
         "budget, N x N micro-occluders per pixel",
         budget,
         budget_tic,
         "budget",
         {error_panel, time_panel, primitive_panel}},
        {"build",
         "Acceleration structures",
         "edge of the map, texels",
         map_size,
         map_tic,
         "",
         {{"time of the build, ms", build_time}, {"memory of the light, MiB", mebibytes}},
         true,
         accel_line},
    };
    std::vector<Plot> plots;
    for (const Sweep &sweep : sweeps)
        for (Plot &plot : sweep_plots_of(sweep, report))
            plots.push_back(std::move(plot));
    return plots;
}
