// Holds counts, memory and errors of fixed settings on fixed scenes to the bounds of one file, or writes that file.
// Nothing is timed. What got better than its bounds fails as well, so that the file always tells the truth.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <getopt.h>

#include "bounds.hpp"
#include "command_line.hpp"
#include "error.hpp"

namespace
{

const CommandLine command_line("regression");

struct Options {
    std::string file, cache, device;
    Selection selection; // empty: all
    bool update = false;
};

void print_help()
{
    std::printf("regression BOUNDS_JSON [--update] [--scene NAME ...] [--technique NAME ...] [--cache DIR] "
                "[--device N|NAME]\n\n"
                "Counts, memory and errors of fixed settings on fixed scenes, held to the bounds of a file.\n"
                "  --update           writes the file\n"
                "  --scene NAME       only this scene; may be repeated; what the file has of others stays\n"
                "  --technique NAME   likewise, with its settings as one argument\n"
                "  --cache DIR        keeps ground truth\n"
                "  --device N|NAME    default: the first GPU, else the software driver\n");
    for (const std::string &name : all_figures().scenes)
        std::printf("scene \"%s\"\n", name.c_str());
    for (const std::string &name : all_figures().techniques)
        std::printf("technique \"%s\"\n", name.c_str());
}

bool contains(const std::vector<std::string> &list, const std::string &name)
{
    return std::find(list.begin(), list.end(), name) != list.end();
}

Options parse(int argc, char **argv)
{
    static const option long_options[] = {{"update", no_argument, nullptr, 'u'},
                                          {"scene", required_argument, nullptr, 's'},
                                          {"technique", required_argument, nullptr, 't'},
                                          {"cache", required_argument, nullptr, 'c'},
                                          {"device", required_argument, nullptr, 'd'},
                                          {"help", no_argument, nullptr, 'h'},
                                          {nullptr, 0, nullptr, 0}};
    const Selection all = all_figures();
    Options o;
    for (int c; (c = getopt_long(argc, argv, "", long_options, nullptr)) != -1;) {
        switch (c) {
        case 'u':
            o.update = true;
            break;
        case 's':
            if (!contains(all.scenes, optarg))
                command_line.error(std::string("unknown scene \"") + optarg + "\"");
            o.selection.scenes.push_back(optarg);
            break;
        case 't':
            if (!contains(all.techniques, optarg))
                command_line.error(std::string("unknown technique \"") + optarg + "\"");
            o.selection.techniques.push_back(optarg);
            break;
        case 'c':
            o.cache = optarg;
            break;
        case 'd':
            o.device = optarg;
            break;
        case 'h':
            print_help();
            std::exit(0);
        default:
            std::exit(2);
        }
    }
    if (argc - optind != 1)
        command_line.error("expected one file of bounds");
    o.file = argv[optind];
    if (o.selection.scenes.empty())
        o.selection.scenes = all.scenes;
    if (o.selection.techniques.empty())
        o.selection.techniques = all.techniques;
    return o;
}

size_t count(const FigureTable<double> &table)
{
    size_t n = 0;
    for (const auto &[scene, techniques] : table)
        for (const auto &[technique, figures] : techniques)
            n += figures.size();
    return n;
}

// What the selection leaves out. Bounds of scenes and techniques that do not exist are not part of it.
FigureTable<Bound> take_others(FigureTable<Bound> &bounds, const Selection &selection)
{
    const Selection all = all_figures();
    FigureTable<Bound> others;
    for (const std::string &scene : all.scenes)
        for (const std::string &technique : all.techniques) {
            const auto found = bounds.find(scene);
            if (found == bounds.end() ||
                (contains(selection.scenes, scene) && contains(selection.techniques, technique)))
                continue;
            if (auto node = found->second.extract(technique))
                others[scene].insert(std::move(node));
        }
    return others;
}

// For the drift that stays within bounds.
FigureTable<Bound> exact(FigureTable<Bound> bounds)
{
    for (auto &[scene, techniques] : bounds)
        for (auto &[technique, figures] : techniques)
            for (auto &[figure, bound] : figures)
                bound.within = 0;
    return bounds;
}

bool run(const Options &o, gpu &g, BoundsFile file)
{
    FigureTable<Bound> others = take_others(file.bounds, o.selection);
    Progress progress;
    const FigureTable<double> measured = measure_figures(g, o.selection, o.cache, progress);
    const std::vector<std::string> moved = compare(file.bounds, measured);
    const std::string device = std::string(g.properties.deviceName) + ", " + g.driver;
    for (const std::string &line : moved)
        std::fprintf(o.update ? stdout : stderr, "%s\n", line.c_str());
    if (o.update) {
        for (auto &[scene, techniques] : bounds_around(measured))
            others[scene].merge(techniques);
        write_bounds(o.file, {device, others});
        std::printf("%zu figures written to %s, %zu had moved\n", count(measured), o.file.c_str(), moved.size());
        return true;
    }
    if (moved.empty()) {
        std::printf("%zu figures within their bounds, %zu of them not where they were\n", count(measured),
                    compare(exact(file.bounds), measured).size());
        return true;
    }
    std::fprintf(stderr, "%zu of %zu figures moved. If they should, better or worse, build the target update-bounds.\n",
                 moved.size(), count(measured));
    if (device != file.device)
        std::fprintf(stderr, "The bounds are from %s; this is %s.\n", file.device.c_str(), device.c_str());
    return false;
}

// An update of everything does without the old file: there may be none, or one that a merge has left half done.
BoundsFile read(const Options &o)
{
    const Selection all = all_figures();
    const bool whole =
        o.selection.scenes.size() == all.scenes.size() && o.selection.techniques.size() == all.techniques.size();
    if (o.update)
        check_writable(o.file);
    if (o.update && !std::filesystem::exists(o.file))
        return {};
    try {
        return read_bounds(o.file);
    } catch (const Error &) {
        if (!o.update || !whole)
            throw;
        return {};
    }
}

} // namespace

int main(int argc, char **argv)
{
    const Options options = parse(argc, argv);
    gpu g{};
    int status = 1;
    try {
        BoundsFile file = read(options); // before anything takes time
        gpu_info info{};
        info.device = options.device.empty() ? nullptr : options.device.c_str();
        if (!gpu_create(&info, &g))
            fail("%s", g.error);
        status = run(options, g, std::move(file)) ? 0 : 1;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "regression: %s\n", error.what());
    }
    gpu_destroy(&g);
    return status;
}
