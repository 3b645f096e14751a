// softshadow-render: renders the depth buffers of a scene or model, runs one technique on them, writes the shaded
// picture.
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <getopt.h>
#include <memory>
#include <unistd.h>

#include "case_io.hpp"
#include "error.hpp"
#include "estimator.hpp"
#include "row.hpp"
#include "scene.hpp"
#include "shade.hpp"
#include "truth.hpp"

namespace fs = std::filesystem;

namespace
{

struct Options {
    std::string scene, model, technique_name = "auto", out, visibility, dump, device;
    std::vector<std::string> settings;
    Technique technique;
    SceneOptions scene_options;
    uint32_t width = 640, height = 480;
    uint32_t map_size = 0;      // 0: the scene's own
    uint32_t truth_samples = 0; // 0: none
    bool stats = false;
};

void print_help()
{
    std::printf(
        "softshadow-render (--scene NAME | --model FILE) --out image.png [options]\n\n"
        "Renders depth buffers for a camera and an area light, runs one technique on them and writes the shaded "
        "picture.\n"
        "The light has two depth layers: the nearest surfaces, and the nearest behind those.\n\n"
        "  --scene NAME        a built-in scene; `--scene list` lists them\n"
        "  --model FILE        a mesh file (OBJ, glTF, PLY, ...), set on a floor\n"
        "  --technique T       default: auto\n"
        "  --set KEY=VALUE     a setting of the technique; may be repeated. layers=1 uses the nearest surfaces only\n"
        "  --light-size X      edge of the square light in world units, 0 to 1000; 0 is a point\n"
        "  --directional       a sun with an orthographic map in place of the square light, as large as that appears\n"
        "  --reversed          reversed depth for camera and map, with an infinite far plane where it can have one\n"
        "  --size WxH          size of the picture, default 640x480\n"
        "  --map N             edge of the light's depth buffer in texels; default: the scene's own\n"
        "  --out FILE          the picture, .png\n"
        "  --visibility FILE   the visible fraction of the light per pixel, .exr\n"
        "  --truth N           traces N rays per pixel with Embree, prints the error against that, and writes the "
        "ray-\n"
        "                      traced picture next to the picture: image-truth.png\n"
        "  --dump CASE_DIR     writes the depth buffers as a case for softshadow-eval, with the truth if there is one\n"
        "  --stats             prints times (median of 3 runs), counts and memory\n"
        "  --device N|NAME     default: the first GPU, else the software driver\n\n"
        "%s",
        technique_help().c_str());
}

[[noreturn]] void usage_error(const std::string &text)
{
    std::fprintf(stderr, "softshadow-render: %s; see --help\n", text.c_str());
    std::exit(2);
}

[[noreturn]] void list_scenes()
{
    for (const SceneName &scene : scene_names())
        std::printf("%-12s %s\n", scene.name, scene.about);
    std::exit(0);
}

// A whole number from 1 to `most` at the start of `text`, which then points behind it; 0 if there is none.
uint32_t take_number(const char *&text, uint32_t most)
{
    if (*text < '0' || *text > '9')
        return 0;
    char *end = nullptr;
    const unsigned long long value = std::strtoull(text, &end, 10);
    text = end;
    return value <= most ? static_cast<uint32_t>(value) : 0;
}

uint32_t parse_number(const char *option, const char *text, uint32_t most)
{
    const char *end = text;
    const uint32_t value = take_number(end, most);
    if (value == 0 || *end != '\0')
        usage_error(std::string(option) + " is \"" + text + "\", expected a whole number from 1 to " +
                    std::to_string(most));
    return value;
}

void parse_size(const char *text, Options &o)
{
    const char *end = text;
    o.width = take_number(end, max_image_size);
    const bool separated = *end == 'x';
    if (separated)
        end++;
    o.height = take_number(end, max_image_size);
    if (o.width == 0 || o.height == 0 || !separated || *end != '\0')
        usage_error(std::string("--size is \"") + text + "\", expected WIDTHxHEIGHT, each from 1 to " +
                    std::to_string(max_image_size));
}

double parse_light_size(const char *text)
{
    char *end = nullptr;
    const double value = std::strtod(text, &end);
    if (end == text || *end != '\0' || !(value >= 0.0 && value <= 1000.0))
        usage_error(std::string("--light-size is \"") + text + "\", expected a number from 0 to 1000");
    return value;
}

bool has_extension(const std::string &path, const char *extension)
{
    std::string end = fs::path(path).extension().string();
    std::transform(end.begin(), end.end(), end.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
    return end == extension;
}

void set_option(int c, Options &o)
{
    switch (c) {
    case 's':
        o.scene = optarg;
        break;
    case 'm':
        o.model = optarg;
        break;
    case 't':
        o.technique_name = optarg;
        break;
    case 'k':
        o.settings.push_back(optarg);
        break;
    case 'l':
        o.scene_options.light_size = parse_light_size(optarg);
        break;
    case 'z':
        parse_size(optarg, o);
        break;
    case 'p':
        o.map_size = parse_number("--map", optarg, SOFTSH_MAX_EXTENT);
        break;
    case 'o':
        o.out = optarg;
        break;
    case 'v':
        o.visibility = optarg;
        break;
    case 'c':
        o.dump = optarg;
        break;
    case 'e':
        o.truth_samples = parse_number("--truth", optarg, 65536);
        break;
    case 'a':
        o.stats = true;
        break;
    case 'd':
        o.device = optarg;
        break;
    case 'D':
        o.scene_options.directional = true;
        break;
    case 'R':
        o.scene_options.reversed_camera = o.scene_options.infinite_camera = o.scene_options.reversed_map = true;
        break;
    case 'h':
        print_help();
        std::exit(0);
    default:
        std::exit(2);
    }
}

Options parse(int argc, char **argv)
{
    static const option long_options[] = {{"scene", required_argument, nullptr, 's'},
                                          {"model", required_argument, nullptr, 'm'},
                                          {"technique", required_argument, nullptr, 't'},
                                          {"set", required_argument, nullptr, 'k'},
                                          {"light-size", required_argument, nullptr, 'l'},
                                          {"size", required_argument, nullptr, 'z'},
                                          {"map", required_argument, nullptr, 'p'},
                                          {"out", required_argument, nullptr, 'o'},
                                          {"visibility", required_argument, nullptr, 'v'},
                                          {"dump", required_argument, nullptr, 'c'},
                                          {"truth", required_argument, nullptr, 'e'},
                                          {"stats", no_argument, nullptr, 'a'},
                                          {"device", required_argument, nullptr, 'd'},
                                          {"directional", no_argument, nullptr, 'D'},
                                          {"reversed", no_argument, nullptr, 'R'},
                                          {"help", no_argument, nullptr, 'h'},
                                          {nullptr, 0, nullptr, 0}};
    Options o;
    for (int c; (c = getopt_long(argc, argv, "", long_options, nullptr)) != -1;)
        set_option(c, o);
    if (optind != argc)
        usage_error(std::string("unexpected argument \"") + argv[optind] + "\"");
    if (o.scene == "list")
        list_scenes();
    if (o.scene.empty() == o.model.empty())
        usage_error("expected either --scene or --model");
    const auto is_scene = [&](const SceneName &known) { return o.scene == known.name; };
    if (o.model.empty() && std::none_of(scene_names().begin(), scene_names().end(), is_scene))
        usage_error("unknown scene \"" + o.scene + "\", expected one of those that --scene list prints");
    if (o.out.empty())
        usage_error("expected --out");
    if (!has_extension(o.out, ".png"))
        usage_error("--out is \"" + o.out + "\", expected a name that ends in .png");
    if (!o.visibility.empty() && !has_extension(o.visibility, ".exr"))
        usage_error("--visibility is \"" + o.visibility + "\", expected a name that ends in .exr");
    // An orthographic projection has no infinite far plane.
    o.scene_options.infinite_map = o.scene_options.reversed_map && !o.scene_options.directional;
    try {
        o.technique = parse_technique(o.technique_name, o.settings);
    } catch (const Error &error) {
        usage_error(error.what());
    }
    return o;
}

// A line on the terminal while something takes long; gone when it is done. Nothing in files and pipes.
class Progress
{
  public:
    ~Progress()
    {
        clear();
    }
    void show(const char *what)
    {
        clear();
        what_ = what;
        start_ = std::chrono::steady_clock::now();
        print(0);
    }
    void fraction(double done)
    {
        if (std::chrono::steady_clock::now() - start_ > std::chrono::seconds(1))
            print(static_cast<int>(100.0 * done));
    }
    void clear()
    {
        if (terminal_)
            std::fputs("\r\033[K", stderr);
    }

  private:
    void print(int percent)
    {
        if (!terminal_)
            return;
        std::fprintf(stderr, "\r%s", what_);
        if (percent > 0)
            std::fprintf(stderr, " %3d %%", percent);
        std::fputs(" ...\033[K", stderr);
        std::fflush(stderr);
    }

    const bool terminal_ = isatty(STDERR_FILENO) != 0;
    const char *what_ = "";
    std::chrono::steady_clock::time_point start_{};
};

std::string truth_path(const std::string &out)
{
    const fs::path path(out);
    return (path.parent_path() / (path.stem().string() + "-truth" + path.extension().string())).string();
}

// Opens for writing without touching what is there.
void check_writable(const std::string &path)
{
    std::error_code code;
    const bool existed = fs::exists(path, code);
    std::FILE *file = fs::is_directory(path, code) ? nullptr : std::fopen(path.c_str(), "ab");
    if (!file)
        fail("%s: cannot be written: %s", path.c_str(), std::strerror(fs::is_directory(path, code) ? EISDIR : errno));
    std::fclose(file);
    if (!existed)
        fs::remove(path, code);
}

void check_outputs(const Options &o)
{
    check_writable(o.out);
    if (o.truth_samples)
        check_writable(truth_path(o.out));
    if (!o.visibility.empty())
        check_writable(o.visibility);
    if (!o.dump.empty()) {
        std::error_code code;
        fs::create_directories(o.dump, code);
        if (!fs::is_directory(o.dump))
            fail("%s: cannot create this folder: %s", o.dump.c_str(),
                 code ? code.message().c_str() : "there is a file of that name");
        check_writable((fs::path(o.dump) / "case.json").string());
    }
}

Case render_depth(gpu &g, const Scene &scene, const Options &o, GBufferPixels &pixels)
{
    Case data;
    data.name = scene.name;
    data.light = scene.light;
    data.triangles = static_cast<uint32_t>(scene.mesh.triangle_count());
    Rasteriser rasteriser(g);
    rasteriser.set_mesh(scene.mesh);
    GBuffer &gbuffer = rasteriser.create_gbuffer(o.width, o.height);
    data.camera.frustum = camera_frustum(scene, o.width, o.height);
    rasteriser.gbuffer(gbuffer, data.camera.frustum, scene.origin);
    pixels = read_gbuffer(g, gbuffer);
    data.camera.depth = pixels.depth;

    const uint32_t size = o.map_size ? o.map_size : scene.map_size;
    DepthTarget *layers[2];
    for (uint32_t i = 0; i < 2; i++) {
        layers[i] = &rasteriser.create_depth_target(size, size);
        rasteriser.depth(*layers[i], scene.map, scene.origin, i ? layers[0] : nullptr);
        CaseMap map;
        map.frustum = scene.map;
        map.depth = read_depth(g, layers[i]->image);
        map.index = i;
        data.maps.push_back(std::move(map));
    }
    return data;
}

void add_truth(Case &data, const Scene &scene, const Options &o, Progress &progress)
{
    TruthOptions options;
    options.samples = o.truth_samples;
    if (scene.light.shape == LightShape::rectangle)
        options.light_near = scene.map_range.near_plane; // nothing nearer is in the map
    progress.show("tracing rays");
    Truth truth = compute_truth(scene.mesh, scene.origin, data.camera, scene.light, options,
                                [&](double done) { progress.fraction(done); });
    progress.clear();
    data.truth = std::move(truth.visibility);
    data.mask = std::move(truth.mask);
    const uint32_t edge = static_cast<uint32_t>(std::sqrt(static_cast<double>(o.truth_samples)) + 1e-9);
    data.truth_light_samples = edge * edge;
}

void measure(Row &row, gpu &g, DeviceCase &device_case, const Technique &technique, Estimator &timed)
{
    std::vector<RunTimes> runs;
    for (int i = 0; i < 3; i++)
        runs.push_back(timed.run());
    add_times(row, runs);
    if (technique.kind != TechniqueKind::library)
        return;
    row.memory = timed.memory();
    const auto counting = make_estimator(g, device_case, technique, true);
    counting->run();
    softsh_stats stats{};
    if (counting->stats(stats))
        row.stats = stats;
}

void print_stats(const Row &row)
{
    std::printf("device      %s, %s\n", row.device.c_str(), row.driver.c_str());
    std::printf("images      %u x %u, map %u x %u\n", row.width, row.height, row.map_size, row.map_size);
    for (const PassTime &pass : row.passes)
        std::printf("time        %9.3f ms  %s\n", pass.ms, pass.name.c_str());
    std::printf("time        %9.3f ms  total\n", row.build_ms + row.visibility_ms);
    if (row.stats) {
        const auto line = [&](const char *name, uint64_t value) {
            std::printf("count   %13llu  %s\n", static_cast<unsigned long long>(value), name);
        };
        line("pixels", row.stats->pixels);
        line("pixels found lit without a look at single occluders", row.stats->lit);
        line("pixels found dark likewise", row.stats->umbra);
        line("pixels evaluated", row.stats->active);
        line("hierarchy texels read", row.stats->nodes);
        line("micro-occluders projected", row.stats->primitives);
    }
    if (row.memory)
        std::printf("memory      %9.2f MiB for the light, %.2f MiB scratch for the view\n",
                    static_cast<double>(row.memory->persistent) / 1048576.0,
                    static_cast<double>(row.memory->transient) / 1048576.0);
}

void run(const Options &o, const Scene &scene, gpu &g, Progress &progress)
{
    progress.show("rendering depth");
    GBufferPixels pixels;
    Case data = render_depth(g, scene, o, pixels);
    progress.show("computing shadows");
    DeviceCase device_case(g, data);
    const auto estimator = make_estimator(g, device_case, o.technique, false);
    estimator->run();
    const FloatImage visibility = estimator->visibility();
    Row row = make_row(g, data, o.technique);
    if (o.stats) {
        progress.show("measuring");
        measure(row, g, device_case, o.technique, *estimator);
    }
    progress.clear();

    const auto picture = [&](const FloatImage &seen) {
        return shade(pixels, seen, data.light, data.camera.frustum, scene.camera.target);
    };
    write_png(o.out, picture(visibility));
    if (!o.visibility.empty())
        write_exr(o.visibility, visibility);
    if (o.truth_samples) {
        add_truth(data, scene, o, progress);
        write_png(truth_path(o.out), picture(*data.truth));
        row.error = measure_error(visibility, *data.truth, &*data.mask);
    }
    if (!o.dump.empty())
        save_case(o.dump, data);
    if (o.truth_samples)
        std::printf("%s\n", to_line(row).c_str());
    if (o.stats)
        print_stats(row);
}

} // namespace

int main(int argc, char **argv)
{
    const Options options = parse(argc, argv);
    const auto g = std::make_unique<gpu>();
    Progress progress;
    int status = 0;
    try {
        check_outputs(options);
        progress.show("loading");
        const Scene scene = options.model.empty() ? make_scene(options.scene, options.scene_options)
                                                  : make_model_scene(options.model, options.scene_options);
        gpu_info info{};
        info.device = options.device.empty() ? nullptr : options.device.c_str();
        if (!gpu_create(&info, g.get()))
            fail("%s", g->error);
        run(options, scene, *g, progress);
    } catch (const std::exception &error) {
        progress.clear();
        std::fprintf(stderr, "softshadow-render: %s\n", error.what());
        status = 1;
    }
    gpu_destroy(g.get());
    if (std::fflush(stdout) != 0 && status == 0) {
        std::fprintf(stderr, "softshadow-render: standard output: %s\n", std::strerror(errno));
        status = 1;
    }
    return status;
}
