// The file of bounds. On one device every figure repeats exactly, given one version of Embree. The widths are for what
// may differ elsewhere, tried by moving camera and light by a thousandth of a pixel:
// - Another rasteriser rounds edges and depths its own way, so that a few pixels change their class, each with all its
//   nodes and primitives, and where surfaces meet or light grazes them, with an error as large as the worst.
// - Truth is 256 rays per pixel, and Embree 3 and 4, or its kernels for another instruction set, decide rays that graze
//   an edge differently: in a pixel one or two rays, 0.004 each.
// - Tiles, levels and memory follow from the sizes of images and are exact. Memory is what the driver asks for its
// images:
//   one that pads them otherwise needs bounds of its own.
#include "bounds.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include <cjson/cJSON.h>

#include "error.hpp"

namespace
{

using Figures = std::map<std::string, double>;
using Json = std::unique_ptr<cJSON, decltype(&cJSON_Delete)>;

constexpr double moved_pixels = 8, moved_tiles = 2, moved_errors = 3;

double width_of(const std::string &figure, const Figures &figures)
{
    const double value = figures.at(figure);
    // The mean of what a few pixels of large error add.
    const double p99 = figures.at("p99"), few = moved_errors / std::max(figures.at("error_pixels"), moved_errors);
    if (figure == "lit" || figure == "umbra" || figure == "active" || figure == "clamped" || figure == "interpolated" ||
        figure == "error_pixels")
        return std::ceil(0.02 * value) + moved_pixels;
    if (figure == "primitives") // of as many pixels
        return std::ceil(0.02 * value + moved_pixels * value / std::max(figures.at("active"), moved_pixels));
    if (figure == "undecided_tiles")
        return std::ceil(0.02 * value) + moved_tiles;
    if (figure == "nodes") // of as many tiles, which is where most queries are
        return std::ceil(0.02 * value + moved_tiles * value / std::max(figures.at("undecided_tiles"), moved_tiles));
    if (figure == "mae")
        return std::max(0.0005, 0.02 * value) + few * p99;
    if (figure == "rmse")
        return std::max(0.001, 0.02 * value) + std::sqrt(value * value + few * p99 * p99) - value;
    if (figure == "p99") // ten pixels decide it where a thousand are shadowed
        return std::max(0.02, 0.3 * value);
    return 0; // tiles, levels, bytes
}

// Six decimals: finer than any width.
double rounded(double value)
{
    return std::round(value * 1e6) / 1e6;
}

std::string number(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.10g", value);
    return text;
}

std::string read_text(const std::string &path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file || std::filesystem::is_directory(path))
        fail("%s: cannot be read", path.c_str());
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void check_object(const cJSON *json, const std::string &path, const std::string &what)
{
    if (!cJSON_IsObject(json))
        fail("%s: %s is not an object", path.c_str(), what.c_str());
}

Bound read_bound(const cJSON *json, const std::string &path, const std::string &what)
{
    const cJSON *value = cJSON_GetArrayItem(json, 0), *within = cJSON_GetArrayItem(json, 1);
    if (!cJSON_IsArray(json) || cJSON_GetArraySize(json) != 2 || !cJSON_IsNumber(value) || !cJSON_IsNumber(within) ||
        !(within->valuedouble >= 0))
        fail("%s: %s is not [value, width]", path.c_str(), what.c_str());
    return {value->valuedouble, within->valuedouble};
}

} // namespace

FigureTable<Bound> bounds_around(const FigureTable<double> &measured)
{
    FigureTable<Bound> bounds;
    for (const auto &[scene, techniques] : measured)
        for (const auto &[technique, figures] : techniques)
            for (const auto &[figure, value] : figures) {
                if (!std::isfinite(value))
                    fail("%s, %s: %s is not finite", scene.c_str(), technique.c_str(), figure.c_str());
                bounds[scene][technique][figure] = {rounded(value), rounded(width_of(figure, figures))};
            }
    return bounds;
}

std::vector<std::string> compare(const FigureTable<Bound> &bounds, const FigureTable<double> &measured)
{
    std::vector<std::string> lines;
    FigureTable<Bound> left = bounds;
    for (const auto &[scene, techniques] : measured)
        for (const auto &[technique, figures] : techniques)
            for (const auto &[figure, value] : figures) {
                const std::string what = scene + ": " + technique + ": " + figure;
                auto &candidates = left[scene][technique];
                const auto found = candidates.find(figure);
                if (found == candidates.end()) {
                    lines.push_back(what + " is " + number(value) + " and has no bounds");
                    continue;
                }
                const Bound b = found->second;
                if (!(std::fabs(value - b.value) <= b.within + 1e-6)) // what rounding took
                    lines.push_back(what + " is " + number(value) + ", bounds " + number(rounded(b.value - b.within)) +
                                    " to " + number(rounded(b.value + b.within)));
                candidates.erase(found);
            }
    for (const auto &[scene, techniques] : left)
        for (const auto &[technique, figures] : techniques)
            for (const auto &[figure, bound] : figures)
                lines.push_back(scene + ": " + technique + ": " + figure + " has bounds and is not measured");
    return lines;
}

BoundsFile read_bounds(const std::string &path)
{
    const std::string text = read_text(path);
    const char *end = nullptr;
    const Json root(cJSON_ParseWithOpts(text.c_str(), &end, true), cJSON_Delete);
    if (!root) {
        const size_t at = std::min(static_cast<size_t>(end - text.c_str()), text.size());
        fail("%s: not JSON, at line %td", path.c_str(),
             1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
    }
    check_object(root.get(), path, "the whole");
    const cJSON *scenes = cJSON_GetObjectItemCaseSensitive(root.get(), "scenes");
    check_object(scenes, path, "scenes");
    BoundsFile file;
    if (const char *device = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(root.get(), "device")))
        file.device = device;
    const cJSON *scene, *technique, *figure;
    cJSON_ArrayForEach(scene, scenes)
    {
        check_object(scene, path, scene->string);
        cJSON_ArrayForEach(technique, scene)
        {
            const std::string in = std::string(scene->string) + ": " + technique->string;
            check_object(technique, path, in);
            cJSON_ArrayForEach(figure, technique)
            {
                const std::string what = in + ": " + figure->string;
                const Bound bound = read_bound(figure, path, what);
                if (!file.bounds[scene->string][technique->string].emplace(figure->string, bound).second)
                    fail("%s: %s is there twice", path.c_str(), what.c_str());
            }
        }
    }
    return file;
}

void write_bounds(const std::string &path, const BoundsFile &file)
{
    const Json root(cJSON_CreateObject(), cJSON_Delete);
    cJSON_AddStringToObject(root.get(), "about",
                            "[value, width]: allowed is value - width to value + width; written by the build target "
                            "update-bounds, see CONTRIBUTING.md");
    cJSON_AddStringToObject(root.get(), "device", file.device.c_str());
    cJSON *scenes = cJSON_AddObjectToObject(root.get(), "scenes");
    for (const auto &[scene, techniques] : file.bounds) {
        cJSON *in_scene = cJSON_AddObjectToObject(scenes, scene.c_str());
        for (const auto &[technique, figures] : techniques) {
            cJSON *in_technique = cJSON_AddObjectToObject(in_scene, technique.c_str());
            for (const auto &[figure, bound] : figures) {
                const double pair[2] = {bound.value, bound.within};
                cJSON_AddItemToObject(in_technique, figure.c_str(), cJSON_CreateDoubleArray(pair, 2));
            }
        }
    }
    const std::unique_ptr<char, decltype(&cJSON_free)> printed(cJSON_Print(root.get()), cJSON_free);
    if (!printed)
        fail("no memory for JSON");
    // cJSON indents with tabs and puts one behind each name.
    std::string text;
    bool indent = true;
    for (const char *c = printed.get(); *c; c++) {
        text += *c == '\t' ? (indent ? "  " : " ") : std::string(1, *c);
        indent = *c == '\n' || (indent && *c == '\t');
    }

    // Written aside and renamed, so that an interrupted update leaves the old file.
    const std::string aside = path + ".part";
    std::ofstream out(aside, std::ios::binary);
    out << text << "\n";
    out.close();
    std::error_code code;
    if (out)
        std::filesystem::rename(aside, path, code);
    if (!out || code)
        fail("%s: cannot be written", path.c_str());
}
