// Error metric, medians, and the JSON row of the tools.
#include "row.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>

#include <cjson/cJSON.h>

#include "error.hpp"

namespace
{

// Between the values at rank q of 0 to 1.
double quantile(std::vector<double> values, double q)
{
    if (values.empty())
        return 0.0;
    std::sort(values.begin(), values.end());
    const double at = q * static_cast<double>(values.size() - 1);
    const size_t below = static_cast<size_t>(at), above = std::min(below + 1, values.size() - 1);
    return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

double median(const std::vector<double> &values)
{
    return quantile(values, 0.5);
}

double sum(const std::vector<PassTime> &passes)
{
    double total = 0;
    for (const PassTime &pass : passes)
        total += pass.ms;
    return total;
}

// The stage a pass belongs to, for time_ms.
const char *stage_of(const std::string &pass)
{
    if (pass.rfind("hierarchy", 0) == 0 || pass == "embree_build")
        return "build";
    if (pass.rfind("classify", 0) == 0)
        return "classify";
    if (pass.rfind("post_filter", 0) == 0)
        return "filter";
    return "evaluate";
}

void add_optional(cJSON *object, const char *name, std::optional<double> value)
{
    if (value && std::isfinite(*value))
        cJSON_AddNumberToObject(object, name, *value);
    else
        cJSON_AddNullToObject(object, name);
}

std::optional<double> per_active(const Row &row, uint64_t softsh_stats::*field)
{
    if (!row.stats || row.stats->active == 0)
        return std::nullopt;
    return static_cast<double>((*row.stats).*field) / static_cast<double>(row.stats->active);
}

std::optional<double> count(const Row &row, uint64_t softsh_stats::*field)
{
    if (!row.stats)
        return std::nullopt;
    return static_cast<double>((*row.stats).*field);
}

std::optional<double> time_figure(const Row &row, double RowTimes::*field)
{
    return row.times ? std::optional<double>((*row.times).*field) : std::nullopt;
}

} // namespace

ErrorMetric measure_error(const FloatImage &result, const FloatImage &truth, const FloatImage *mask)
{
    if (result.width != truth.width || result.height != truth.height)
        fail("the result is %u x %u and the truth %u x %u", result.width, result.height, truth.width, truth.height);
    ErrorMetric metric;
    std::vector<float> errors;
    double total = 0, squares = 0;
    for (size_t i = 0; i < result.texels.size(); i++) {
        if ((mask && mask->texels[i] < 0.5f) || !(result.texels[i] < 1.0f || truth.texels[i] < 1.0f))
            continue;
        const float e = std::fabs(result.texels[i] - truth.texels[i]);
        errors.push_back(e);
        total += static_cast<double>(e);
        squares += static_cast<double>(e) * static_cast<double>(e);
    }
    metric.pixels = errors.size();
    if (errors.empty())
        return metric;
    const double n = static_cast<double>(errors.size());
    metric.mae = total / n;
    metric.rmse = std::sqrt(squares / n);
    const auto rank = errors.begin() + static_cast<std::ptrdiff_t>(0.99 * (n - 1));
    std::nth_element(errors.begin(), rank, errors.end());
    metric.p99 = static_cast<double>(*rank);
    metric.max = static_cast<double>(*std::max_element(errors.begin(), errors.end()));
    return metric;
}

Row make_row(const gpu &g, const Case &data, const Technique &technique)
{
    Row row;
    row.case_name = data.name;
    row.device = g.properties.deviceName;
    row.driver = g.driver;
    row.technique = technique;
    row.width = data.camera.depth.width;
    row.height = data.camera.depth.height;
    row.map_size = data.maps.empty() ? 0 : data.maps[0].depth.width;
    row.light_size = data.light.shape == LightShape::directional
                         ? 2 * data.light.angular_radius
                         : 2 * std::max(glm::length(data.light.half_u), glm::length(data.light.half_v));
    return row;
}

std::optional<RowTimes> summarise(const std::vector<RunTimes> &runs)
{
    if (runs.empty())
        return std::nullopt;
    std::vector<double> build, visibility, total, wall;
    std::map<std::string, std::vector<double>> passes;
    std::vector<std::string> order;
    for (const RunTimes &run : runs) {
        build.push_back(sum(run.build));
        visibility.push_back(sum(run.visibility));
        total.push_back(build.back() + visibility.back());
        wall.push_back(run.wall_ms);
        std::map<std::string, double> sums;
        for (const auto *list : {&run.build, &run.visibility}) {
            for (const PassTime &pass : *list) {
                sums[pass.name] += pass.ms;
                if (std::find(order.begin(), order.end(), pass.name) == order.end())
                    order.push_back(pass.name);
            }
        }
        for (const auto &[name, ms] : sums)
            passes[name].push_back(ms);
    }
    RowTimes times;
    times.runs = static_cast<uint32_t>(runs.size());
    times.build = median(build);
    times.visibility = median(visibility);
    times.total = median(total);
    times.total_low = quantile(total, 0.25);
    times.total_high = quantile(total, 0.75);
    times.wall = median(wall);
    for (const std::string &name : order)
        times.passes.push_back({name, median(passes[name])});
    return times;
}

std::optional<double> stage_ms(const Row &row, const std::string &stage)
{
    std::optional<double> ms;
    if (row.times)
        for (const PassTime &pass : row.times->passes)
            if (stage == stage_of(pass.name))
                ms = ms.value_or(0.0) + pass.ms;
    return ms;
}

std::string to_json(const Row &row)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "case", row.case_name.c_str());
    cJSON_AddStringToObject(json, "device", row.device.c_str());
    cJSON_AddStringToObject(json, "driver", row.driver.c_str());
    cJSON_AddStringToObject(json, "technique", row.technique.name.c_str());
    cJSON *settings = cJSON_AddObjectToObject(json, "settings");
    for (const auto &[key, value] : row.technique.settings)
        cJSON_AddStringToObject(settings, key.c_str(), value.c_str());
    cJSON_AddNumberToObject(json, "width", row.width);
    cJSON_AddNumberToObject(json, "height", row.height);
    cJSON_AddNumberToObject(json, "map_size", row.map_size);
    cJSON_AddNumberToObject(json, "light_size", row.light_size);

    if (!row.suite.empty())
        cJSON_AddStringToObject(json, "suite", row.suite.c_str());
    if (!row.variant.empty())
        cJSON_AddStringToObject(json, "variant", row.variant.c_str());

    cJSON *time = cJSON_AddObjectToObject(json, "time_ms");
    for (const char *stage : {"build", "classify", "evaluate", "filter"})
        add_optional(time, stage, stage_ms(row, stage));
    add_optional(time, "total", time_figure(row, &RowTimes::total));
    add_optional(time, "total_low", time_figure(row, &RowTimes::total_low));
    add_optional(time, "total_high", time_figure(row, &RowTimes::total_high));
    add_optional(time, "wall", time_figure(row, &RowTimes::wall));
    cJSON_AddNumberToObject(time, "runs", row.times ? row.times->runs : 0);
    cJSON *passes = cJSON_AddObjectToObject(time, "passes");
    if (row.times)
        for (const PassTime &pass : row.times->passes)
            cJSON_AddNumberToObject(passes, pass.name.c_str(), pass.ms);

    cJSON *counts = cJSON_AddObjectToObject(json, "counts");
    add_optional(counts, "pixels", count(row, &softsh_stats::pixels));
    add_optional(counts, "lit", count(row, &softsh_stats::lit));
    add_optional(counts, "umbra", count(row, &softsh_stats::umbra));
    add_optional(counts, "active", count(row, &softsh_stats::active));
    add_optional(counts, "nodes_per_active", per_active(row, &softsh_stats::nodes));
    add_optional(counts, "primitives_per_active", per_active(row, &softsh_stats::primitives));
    add_optional(counts, "visited_per_active", per_active(row, &softsh_stats::visited));
    add_optional(counts, "tiles", count(row, &softsh_stats::tiles));
    add_optional(counts, "undecided_tiles", count(row, &softsh_stats::undecided_tiles));
    add_optional(counts, "clamped", count(row, &softsh_stats::clamped));
    add_optional(counts, "interpolated", count(row, &softsh_stats::interpolated));
    add_optional(counts, "refined", count(row, &softsh_stats::refined));
    add_optional(counts, "edges", count(row, &softsh_stats::edges));
    add_optional(counts, "visited", count(row, &softsh_stats::visited));
    add_optional(counts, "packets", count(row, &softsh_stats::packets));
    add_optional(counts, "incoherent", count(row, &softsh_stats::incoherent));
    add_optional(counts, "diverged", count(row, &softsh_stats::diverged));
    std::optional<double> built, skipped;
    if (row.stats) {
        built = row.stats->wide_levels_built;
        skipped = row.stats->wide_levels_skipped;
    }
    add_optional(counts, "wide_levels_built", built);
    add_optional(counts, "wide_levels_skipped", skipped);

    cJSON *memory = cJSON_AddObjectToObject(json, "memory_bytes");
    std::optional<double> persistent, transient;
    if (row.memory) {
        persistent = static_cast<double>(row.memory->persistent);
        transient = static_cast<double>(row.memory->transient);
    }
    add_optional(memory, "persistent", persistent);
    add_optional(memory, "transient", transient);

    cJSON *error = cJSON_AddObjectToObject(json, "error");
    std::optional<double> mae, rmse, p99, max, pixels;
    if (row.error) {
        mae = row.error->mae;
        rmse = row.error->rmse;
        p99 = row.error->p99;
        max = row.error->max;
        pixels = static_cast<double>(row.error->pixels);
    }
    add_optional(error, "mae", mae);
    add_optional(error, "rmse", rmse);
    add_optional(error, "p99", p99);
    add_optional(error, "max", max);
    add_optional(error, "pixels", pixels);

    if (row.front)
        cJSON_AddBoolToObject(json, "front", *row.front);
    if (!row.measures.empty()) {
        cJSON *measures = cJSON_AddObjectToObject(json, "measures");
        for (const auto &[name, value] : row.measures)
            add_optional(measures, name.c_str(), value);
    }

    char *text = cJSON_Print(json);
    cJSON_Delete(json);
    if (!text)
        fail("no memory for JSON");
    const std::string result = std::string(text) + "\n";
    cJSON_free(text);
    return result;
}

std::string csv_header()
{
    return "suite,case,variant,device,driver,technique,settings,width,height,map_size,light_size,build_ms,classify_ms,"
           "evaluate_ms,"
           "filter_ms,total_ms,total_low_ms,total_high_ms,wall_ms,runs,pixels,lit,umbra,active,nodes_per_active,"
           "primitives_per_active,persistent_bytes,transient_bytes,mae,rmse,p99,max,error_pixels,front\n";
}

std::string to_csv(const Row &row)
{
    std::string line;
    const auto text = [&](const std::string &value) {
        std::string quoted = value;
        for (size_t at = 0; (at = quoted.find('"', at)) != std::string::npos; at += 2)
            quoted.insert(at, 1, '"');
        line += (line.empty() ? "\"" : ",\"") + quoted + "\"";
    };
    const auto figure = [&](std::optional<double> value) {
        char digits[32] = "";
        if (value && std::isfinite(*value))
            std::snprintf(digits, sizeof digits, "%.9g", *value);
        line += std::string(",") + digits;
    };
    std::string settings;
    for (const auto &[key, value] : row.technique.settings)
        settings += (settings.empty() ? "" : " ") + key + "=" + value;
    for (const std::string &value :
         {row.suite, row.case_name, row.variant, row.device, row.driver, row.technique.name, settings})
        text(value);
    for (const double value : {double(row.width), double(row.height), double(row.map_size), row.light_size})
        figure(value);
    for (const char *stage : {"build", "classify", "evaluate", "filter"})
        figure(stage_ms(row, stage));
    for (const auto field : {&RowTimes::total, &RowTimes::total_low, &RowTimes::total_high, &RowTimes::wall})
        figure(time_figure(row, field));
    figure(row.times ? row.times->runs : 0);
    for (const auto field : {&softsh_stats::pixels, &softsh_stats::lit, &softsh_stats::umbra, &softsh_stats::active})
        figure(count(row, field));
    for (const auto field : {&softsh_stats::nodes, &softsh_stats::primitives})
        figure(per_active(row, field));
    figure(row.memory ? std::optional<double>(row.memory->persistent) : std::nullopt);
    figure(row.memory ? std::optional<double>(row.memory->transient) : std::nullopt);
    for (const auto field : {&ErrorMetric::mae, &ErrorMetric::rmse, &ErrorMetric::p99, &ErrorMetric::max})
        figure(row.error ? std::optional<double>((*row.error).*field) : std::nullopt);
    figure(row.error ? std::optional<double>(row.error->pixels) : std::nullopt);
    figure(row.front ? std::optional<double>(*row.front) : std::nullopt);
    return line + "\n";
}

std::string to_line(const Row &row)
{
    char text[512];
    std::string line;
    std::snprintf(text, sizeof text, "%-10s %-52s", row.case_name.c_str(), describe(row.technique).c_str());
    line = text;
    if (row.error) {
        std::snprintf(text, sizeof text, "  error %.4f (rms %.4f)", row.error->mae, row.error->rmse);
        line += text;
    }
    if (row.times) {
        std::snprintf(text, sizeof text, "  %9.2f ms (build %.2f)", row.times->total, row.times->build);
        line += text;
    }
    if (row.stats) {
        std::snprintf(text, sizeof text, "  active %llu, %.0f primitives each",
                      static_cast<unsigned long long>(row.stats->active),
                      per_active(row, &softsh_stats::primitives).value_or(0.0));
        line += text;
    }
    return line;
}
