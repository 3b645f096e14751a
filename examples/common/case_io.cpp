// Reading and writing the case format. Reading trusts nothing: every field is checked before it is used, and images are
// compared with the size declared for them.
#include "case_io.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include <cJSON.h>

#include "error.hpp"

namespace fs = std::filesystem;

namespace
{

constexpr uintmax_t max_json_size = 64u << 20;
constexpr int max_maps = 1024;

struct JsonDeleter {
    void operator()(cJSON *json) const
    {
        cJSON_Delete(json);
    }
};
using Json = std::unique_ptr<cJSON, JsonDeleter>;

// A JSON value that knows where it is, so that every complaint can say so.
struct Value {
    const cJSON *json = nullptr;
    std::string file;
    std::string path; // such as maps[1].view

    [[noreturn]] void expected(const std::string &what) const
    {
        fail("%s: %s: expected %s", file.c_str(), path.c_str(), what.c_str());
    }
    bool has(const char *key) const
    {
        return cJSON_GetObjectItemCaseSensitive(json, key) != nullptr;
    }
    Value member(const char *key) const
    {
        if (!cJSON_IsObject(json))
            expected("an object");
        Value value{cJSON_GetObjectItemCaseSensitive(json, key), file, path.empty() ? key : path + "." + key};
        if (!value.json)
            fail("%s: %s: missing", file.c_str(), value.path.c_str());
        return value;
    }
    Value element(int i) const
    {
        return {cJSON_GetArrayItem(json, i), file, path + "[" + std::to_string(i) + "]"};
    }
    int array_size(const std::string &what) const
    {
        if (!cJSON_IsArray(json))
            expected(what);
        return cJSON_GetArraySize(json);
    }
    std::string text() const
    {
        if (!cJSON_IsString(json))
            expected("a string");
        return json->valuestring;
    }
    // Names may not leave the folder of the case.
    std::string file_name() const
    {
        const std::string name = text();
        if (name.empty() || fs::path(name).is_absolute() || name.find("..") != std::string::npos)
            expected("the name of a file in the case's folder");
        return name;
    }
    double number(double lowest, double highest) const
    {
        // cJSON reads an overflowing literal such as 1e999 as infinity.
        if (!cJSON_IsNumber(json) || !(json->valuedouble >= lowest && json->valuedouble <= highest)) {
            char what[96];
            if (std::isinf(highest) || highest >= 1e300)
                std::snprintf(what, sizeof what, "a finite number");
            else
                std::snprintf(what, sizeof what, "a number from %.9g to %.9g", lowest, highest);
            expected(what);
        }
        return json->valuedouble;
    }
    double finite() const
    {
        return number(-1.7e308, 1.7e308);
    }
    uint32_t integer(uint32_t lowest, uint32_t highest) const
    {
        const double value = cJSON_IsNumber(json) ? json->valuedouble : -1.0;
        if (!(value >= lowest && value <= highest) || value != std::floor(value))
            expected("an integer from " + std::to_string(lowest) + " to " + std::to_string(highest));
        return static_cast<uint32_t>(value);
    }
    glm::dvec3 vector() const
    {
        const std::string what = "an array of 3 finite numbers";
        if (array_size(what) != 3)
            expected(what);
        return {element(0).finite(), element(1).finite(), element(2).finite()};
    }
    glm::dmat4 matrix() const
    {
        const std::string what = "an array of 16 finite numbers (column-major matrix)";
        if (array_size(what) != 16)
            expected(what);
        glm::dmat4 m;
        const cJSON *item = json->child;
        for (int i = 0; i < 16; i++, item = item->next)
            m[i / 4][i % 4] = Value{item, file, path + "[" + std::to_string(i) + "]"}.finite();
        const double determinant = glm::determinant(m);
        if (!std::isfinite(determinant) || determinant == 0.0)
            expected("an invertible matrix");
        return m;
    }
};

bool read_convention(const Value &value)
{
    const std::string name = value.text();
    if (name != "zero_to_one" && name != "reversed")
        value.expected("\"zero_to_one\" or \"reversed\"");
    return name == "reversed";
}

FloatImage read_image(const Value &name, const fs::path &folder, uint32_t width, uint32_t height)
{
    const std::string path = (folder / name.file_name()).string();
    FloatImage image = read_exr(path);
    if (image.width != width || image.height != height)
        fail("%s: size %ux%u, expected %ux%u as %s in case.json says", path.c_str(), image.width, image.height, width,
             height, name.path.c_str());
    return image;
}

DepthView read_depth_view(const Value &value, const fs::path &folder)
{
    const uint32_t width = value.member("width").integer(1, max_image_size);
    const uint32_t height = value.member("height").integer(1, max_image_size);
    DepthView view;
    view.frustum.reversed = read_convention(value.member("depth_convention"));
    view.frustum.view = value.member("view").matrix();
    view.frustum.projection = value.member("projection").matrix();
    view.depth = read_image(value.member("depth"), folder, width, height);
    return view;
}

Light read_light(const Value &value)
{
    const Value shape = value.member("shape");
    const std::string name = shape.text();
    Light light;
    if (name == "rectangle")
        light.shape = LightShape::rectangle;
    else if (name == "disc")
        light.shape = LightShape::disc;
    else if (name == "sphere")
        light.shape = LightShape::sphere;
    else if (name == "directional")
        light.shape = LightShape::directional;
    else
        shape.expected("\"rectangle\", \"disc\", \"sphere\" or \"directional\"");
    if (light.shape == LightShape::directional) {
        const Value direction = value.member("direction");
        light.direction = direction.vector();
        const double length = glm::length(light.direction);
        if (!(length > 0.0 && std::isfinite(length)))
            direction.expected("a vector that is not zero");
        light.direction /= length;
        light.angular_radius = value.member("angular_radius").number(0.0, 1.5);
    } else {
        light.centre = value.member("center").vector();
        light.half_u = value.member("half_u").vector();
        light.half_v = value.member("half_v").vector();
    }
    return light;
}

void read_pair(const Value &value, uint32_t lowest, uint32_t highest, uint32_t out[2])
{
    const std::string what = "an array of 2 integers";
    if (value.array_size(what) != 2)
        value.expected(what);
    for (int i = 0; i < 2; i++)
        out[i] = value.element(i).integer(lowest, highest);
}

CaseMap read_map(const Value &value, const fs::path &folder)
{
    const Value role = value.member("role");
    const std::string name = role.text();
    CaseMap map;
    if (name == "layer")
        map.role = MapRole::layer;
    else if (name == "sublight")
        map.role = MapRole::sublight;
    else if (name == "face")
        map.role = MapRole::face;
    else if (name == "cascade")
        map.role = MapRole::cascade;
    else
        role.expected("\"layer\", \"sublight\", \"face\" or \"cascade\"");
    if (map.role == MapRole::sublight) {
        read_pair(value.member("grid"), 1, 64, map.grid);
        read_pair(value.member("cell"), 0, 63, map.cell);
        if (map.cell[0] >= map.grid[0] || map.cell[1] >= map.grid[1])
            value.member("cell").expected("a cell inside the grid");
    } else {
        map.index = value.member("index").integer(0, max_maps - 1);
    }
    static_cast<DepthView &>(map) = read_depth_view(value, folder);
    return map;
}

// One map for each cell of one grid.
void check_grid(const Value &value, const std::vector<CaseMap> &maps)
{
    const uint32_t(&grid)[2] = maps[0].grid;
    const std::string name = std::to_string(grid[0]) + " x " + std::to_string(grid[1]);
    if (maps.size() != grid[0] * grid[1])
        value.expected(std::to_string(grid[0] * grid[1]) + " maps for a grid of " + name + ", not " +
                       std::to_string(maps.size()));
    std::vector<bool> found(maps.size());
    for (size_t i = 0; i < maps.size(); i++) {
        const Value element = value.element(static_cast<int>(i));
        if (maps[i].grid[0] != grid[0] || maps[i].grid[1] != grid[1])
            element.member("grid").expected("the grid of the other maps, " + name);
        const size_t cell = maps[i].cell[0] + grid[0] * maps[i].cell[1];
        if (found[cell])
            element.member("cell").expected("a cell that no other map has");
        found[cell] = true;
    }
}

std::string read_text_file(const std::string &path)
{
    std::error_code code;
    if (!fs::is_regular_file(path, code))
        fail("%s: no such file, expected a folder with case.json", path.c_str());
    if (fs::file_size(path, code) > max_json_size || code)
        fail("%s: unreadable or larger than %ju bytes", path.c_str(), max_json_size);
    std::ifstream stream(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    if (!stream)
        fail("%s: cannot be read", path.c_str());
    return text;
}

// Nine significant digits identify a float; matrices were doubles, and seventeen identify those.
class Writer
{
  public:
    explicit Writer(const std::string &path) : path_(path), file_(std::fopen(path.c_str(), "wb"))
    {
        if (!file_)
            fail("%s: cannot be written: %s", path.c_str(), std::strerror(errno));
    }
    Writer(const Writer &) = delete;
    Writer &operator=(const Writer &) = delete;
    ~Writer()
    {
        if (file_)
            std::fclose(file_);
    }
    void text(const std::string &s)
    {
        std::fputs(s.c_str(), file_);
    }
    void number(double value)
    {
        std::fprintf(file_, "%.17g", value);
    }
    void numbers(const double *values, int count)
    {
        text("[");
        for (int i = 0; i < count; i++) {
            text(i ? ", " : "");
            number(values[i]);
        }
        text("]");
    }
    void vector(const char *key, const glm::dvec3 &v)
    {
        text(std::string("\"") + key + "\": ");
        numbers(&v[0], 3);
    }
    void depth_view(const DepthView &view, const std::string &file)
    {
        text("\"width\": " + std::to_string(view.depth.width) + ", \"height\": " + std::to_string(view.depth.height) +
             ", \"depth\": \"" + file + "\", \"depth_convention\": \"" +
             (view.frustum.reversed ? "reversed" : "zero_to_one") + "\",\n    \"view\": ");
        numbers(&view.frustum.view[0][0], 16);
        text(",\n    \"projection\": ");
        numbers(&view.frustum.projection[0][0], 16);
    }
    void close()
    {
        const bool bad = std::ferror(file_) != 0;
        const bool closed = std::fclose(file_) == 0;
        file_ = nullptr;
        if (bad || !closed)
            fail("%s: cannot be written: %s", path_.c_str(), std::strerror(errno));
    }

  private:
    std::string path_;
    std::FILE *file_;
};

std::string map_file_name(const CaseMap &map)
{
    const std::string index = std::to_string(map.index);
    switch (map.role) {
    case MapRole::layer:
        return map.index == 0 ? "shadow.exr" : "shadow-layer" + index + ".exr";
    case MapRole::sublight:
        return "shadow-" + std::to_string(map.cell[0]) + "-" + std::to_string(map.cell[1]) + ".exr";
    case MapRole::face:
        return "shadow-face" + index + ".exr";
    case MapRole::cascade:
        break;
    }
    return "shadow-cascade" + index + ".exr";
}

void write_light(Writer &out, const Light &light)
{
    out.text(std::string("  \"light\": {\"shape\": \"") + light_shape_name(light.shape) + "\", ");
    if (light.shape == LightShape::directional) {
        out.vector("direction", light.direction);
        out.text(", \"angular_radius\": ");
        out.number(light.angular_radius);
    } else {
        out.vector("center", light.centre);
        out.text(", ");
        out.vector("half_u", light.half_u);
        out.text(", ");
        out.vector("half_v", light.half_v);
    }
    out.text("},\n");
}

void write_map(Writer &out, const CaseMap &map)
{
    out.text(std::string("{\"role\": \"") + map_role_name(map.role) + "\", ");
    if (map.role == MapRole::sublight)
        out.text("\"grid\": [" + std::to_string(map.grid[0]) + ", " + std::to_string(map.grid[1]) + "], \"cell\": [" +
                 std::to_string(map.cell[0]) + ", " + std::to_string(map.cell[1]) + "], ");
    else
        out.text("\"index\": " + std::to_string(map.index) + ", ");
    out.depth_view(map, map_file_name(map));
    out.text("}");
}

} // namespace

const char *map_role_name(MapRole role)
{
    switch (role) {
    case MapRole::layer:
        return "layer";
    case MapRole::sublight:
        return "sublight";
    case MapRole::face:
        return "face";
    case MapRole::cascade:
        break;
    }
    return "cascade";
}

Case load_case(const std::string &folder)
{
    const std::string path = (fs::path(folder) / "case.json").string();
    const std::string text = read_text_file(path);
    const char *end = nullptr;
    const Json json(cJSON_ParseWithLengthOpts(text.c_str(), text.size() + 1, &end, 1));
    if (!json) {
        // Quoted up to the end of its line: NaN and Infinity, which some writers emit, are then seen at once.
        const std::string rest = end ? end : "";
        const auto line = end ? std::count(text.c_str(), end, '\n') + 1 : 1;
        fail("%s: not valid JSON at line %td: '%s'", path.c_str(), line,
             rest.substr(0, rest.find('\n')).substr(0, 40).c_str());
    }

    const Value root{json.get(), path, ""};
    if (!cJSON_IsObject(root.json))
        fail("%s: expected an object", path.c_str());
    Case data;
    data.name = fs::absolute(folder).lexically_normal().filename().string();
    if (data.name.empty())
        data.name = fs::absolute(folder).lexically_normal().parent_path().filename().string();
    data.light = read_light(root.member("light"));
    data.camera = read_depth_view(root.member("camera"), folder);
    const Value maps = root.member("maps");
    const int count = maps.array_size("an array of maps");
    if (count < 1 || count > max_maps)
        maps.expected("1 to " + std::to_string(max_maps) + " maps");
    for (int i = 0; i < count; i++) {
        data.maps.push_back(read_map(maps.element(i), folder));
        if (data.maps[static_cast<size_t>(i)].role != data.maps[0].role)
            maps.element(i).member("role").expected("the same role for all maps");
    }
    if (data.maps[0].role == MapRole::sublight)
        check_grid(maps, data.maps);
    const FloatImage &depth = data.camera.depth;
    if (root.has("truth"))
        data.truth = read_image(root.member("truth"), folder, depth.width, depth.height);
    if (root.has("mask"))
        data.mask = read_image(root.member("mask"), folder, depth.width, depth.height);
    if (root.has("truth_light_samples"))
        data.truth_light_samples = root.member("truth_light_samples").integer(1, 1u << 24);
    if (root.has("triangles"))
        data.triangles = root.member("triangles").integer(0, UINT32_MAX);
    return data;
}

void save_case(const std::string &folder, const Case &data)
{
    std::error_code code;
    fs::create_directories(folder, code);
    if (!fs::is_directory(folder, code))
        fail("%s: cannot create this folder", folder.c_str());
    const fs::path base(folder);
    fs::remove(base / "case.json", code);
    write_exr((base / "camera.exr").string(), data.camera.depth);
    for (const CaseMap &map : data.maps)
        write_exr((base / map_file_name(map)).string(), map.depth);
    if (data.truth)
        write_exr((base / "truth.exr").string(), *data.truth);
    if (data.mask)
        write_exr((base / "mask.exr").string(), *data.mask);

    Writer out((base / "case.json").string());
    out.text("{\n  \"camera\": {");
    out.depth_view(data.camera, "camera.exr");
    out.text("},\n");
    write_light(out, data.light);
    out.text("  \"maps\": [");
    for (size_t i = 0; i < data.maps.size(); i++) {
        out.text(i ? ",\n    " : "");
        write_map(out, data.maps[i]);
    }
    out.text("]");
    if (data.truth)
        out.text(",\n  \"truth\": \"truth.exr\"");
    if (data.mask)
        out.text(",\n  \"mask\": \"mask.exr\"");
    if (data.truth_light_samples)
        out.text(",\n  \"truth_light_samples\": " + std::to_string(data.truth_light_samples));
    if (data.triangles)
        out.text(",\n  \"triangles\": " + std::to_string(data.triangles));
    out.text("\n}\n");
    out.close();
}
