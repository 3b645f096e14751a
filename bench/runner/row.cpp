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

double median(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    const size_t n = values.size();
    return n == 0 ? 0.0 : n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
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
    if (pass.rfind("hierarchy", 0) == 0)
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

void add_times(Row &row, const std::vector<RunTimes> &runs)
{
    std::vector<double> build, visibility;
    std::map<std::string, std::vector<double>> passes;
    std::vector<std::string> order;
    for (const RunTimes &run : runs) {
        build.push_back(sum(run.build));
        visibility.push_back(sum(run.visibility));
        std::map<std::string, double> totals;
        for (const auto *list : {&run.build, &run.visibility}) {
            for (const PassTime &pass : *list) {
                totals[pass.name] += pass.ms;
                if (std::find(order.begin(), order.end(), pass.name) == order.end())
                    order.push_back(pass.name);
            }
        }
        for (const auto &[name, ms] : totals)
            passes[name].push_back(ms);
    }
    row.build_ms = median(build);
    row.visibility_ms = median(visibility);
    row.passes.clear();
    for (const std::string &name : order)
        row.passes.push_back({name, median(passes[name])});
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

    cJSON *time = cJSON_AddObjectToObject(json, "time_ms");
    const bool timed = !row.passes.empty();
    std::map<std::string, double> stages;
    for (const PassTime &pass : row.passes)
        stages[stage_of(pass.name)] += pass.ms;
    for (const char *stage : {"build", "classify", "evaluate", "filter"})
        add_optional(time, stage, stages.count(stage) ? std::optional<double>(stages[stage]) : std::nullopt);
    add_optional(time, "total", timed ? std::optional<double>(row.build_ms + row.visibility_ms) : std::nullopt);
    cJSON *passes = cJSON_AddObjectToObject(time, "passes");
    for (const PassTime &pass : row.passes)
        cJSON_AddNumberToObject(passes, pass.name.c_str(), pass.ms);

    cJSON *counts = cJSON_AddObjectToObject(json, "counts");
    add_optional(counts, "pixels", count(row, &softsh_stats::pixels));
    add_optional(counts, "lit", count(row, &softsh_stats::lit));
    add_optional(counts, "umbra", count(row, &softsh_stats::umbra));
    add_optional(counts, "active", count(row, &softsh_stats::active));
    add_optional(counts, "nodes_per_active", per_active(row, &softsh_stats::nodes));
    add_optional(counts, "primitives_per_active", per_active(row, &softsh_stats::primitives));
    add_optional(counts, "tiles", count(row, &softsh_stats::tiles));
    add_optional(counts, "undecided_tiles", count(row, &softsh_stats::undecided_tiles));
    add_optional(counts, "clamped", count(row, &softsh_stats::clamped));
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

    char *text = cJSON_Print(json);
    cJSON_Delete(json);
    if (!text)
        fail("no memory for JSON");
    const std::string result = std::string(text) + "\n";
    cJSON_free(text);
    return result;
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
    if (!row.passes.empty()) {
        std::snprintf(text, sizeof text, "  %9.2f ms (build %.2f)", row.build_ms + row.visibility_ms, row.build_ms);
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
