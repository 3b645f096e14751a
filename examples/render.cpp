// softshadow-render: renders the depth buffers of a scene or model, runs one technique on them, writes the shaded
// picture.
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <getopt.h>
#include <memory>

#include "case_io.hpp"
#include "command_line.hpp"
#include "error.hpp"
#include "estimator.hpp"
#include "progress.hpp"
#include "row.hpp"
#include "scene_case.hpp"
#include "shade.hpp"

namespace fs = std::filesystem;

namespace
{

struct Options {
    std::string scene, model, technique_name = "auto", out, visibility, dump, device;
    std::vector<std::string> settings;
    Technique technique;
    SceneOptions scene_options;
    SceneCaseOptions size;
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
        "  --sublights N       N x N parts of the square light, each with a map of one layer, in place of the layers\n"
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

const CommandLine command_line("softshadow-render");

[[noreturn]] void list_scenes()
{
    for (const SceneName &scene : scene_names())
        std::printf("%-12s %s\n", scene.name, scene.about);
    std::exit(0);
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
        o.scene_options.light_size = command_line.real("--light-size", optarg, 0.0, 1000.0);
        break;
    case 'u':
        o.size.sublights = command_line.whole("--sublights", optarg, 1, 8);
        break;
    case 'z':
        command_line.size("--size", optarg, o.size.width, o.size.height);
        break;
    case 'p':
        o.size.map_size = command_line.whole("--map", optarg, 1, SOFTSH_MAX_EXTENT);
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
        o.truth_samples = command_line.whole("--truth", optarg, 1, 65536);
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
                                          {"sublights", required_argument, nullptr, 'u'},
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
        command_line.error(std::string("unexpected argument \"") + argv[optind] + "\"");
    if (o.scene == "list")
        list_scenes();
    if (o.scene.empty() == o.model.empty())
        command_line.error("expected either --scene or --model");
    const auto is_scene = [&](const SceneName &known) { return o.scene == known.name; };
    if (o.model.empty() && std::none_of(scene_names().begin(), scene_names().end(), is_scene))
        command_line.error("unknown scene \"" + o.scene + "\", expected one of those that --scene list prints");
    if (o.out.empty())
        command_line.error("expected --out");
    if (!has_extension(o.out, ".png"))
        command_line.error("--out is \"" + o.out + "\", expected a name that ends in .png");
    if (!o.visibility.empty() && !has_extension(o.visibility, ".exr"))
        command_line.error("--visibility is \"" + o.visibility + "\", expected a name that ends in .exr");
    // An orthographic projection has no infinite far plane.
    o.scene_options.infinite_map = o.scene_options.reversed_map && !o.scene_options.directional;
    try {
        o.technique = parse_technique(o.technique_name, o.settings);
    } catch (const Error &error) {
        command_line.error(error.what());
    }
    return o;
}

std::string truth_path(const std::string &out)
{
    const fs::path path(out);
    return (path.parent_path() / (path.stem().string() + "-truth" + path.extension().string())).string();
}

void check_outputs(const Options &o)
{
    check_writable(o.out);
    if (o.truth_samples)
        check_writable(truth_path(o.out));
    if (!o.visibility.empty())
        check_writable(o.visibility);
    if (!o.dump.empty())
        check_writable_folder(o.dump, "case.json");
}

void measure(Row &row, gpu &g, DeviceCase &device_case, const Technique &technique, Estimator &timed)
{
    std::vector<RunTimes> runs;
    for (int i = 0; i < 3; i++)
        runs.push_back(timed_run(timed));
    row.times = summarise(runs);
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
    for (const PassTime &pass : row.times->passes)
        std::printf("time        %9.3f ms  %s\n", pass.ms, pass.name.c_str());
    std::printf("time        %9.3f ms  total\n", row.times->total);
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
    Case data = render_case(g, scene, o.size, &pixels);
    progress.show("computing shadows");
    DeviceCase device_case(g, data, &scene);
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
        progress.show("tracing rays");
        add_truth(data, scene, o.truth_samples, "", progress);
        progress.clear();
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
