// softshadow-bench: time against error of every technique, in one process.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <getopt.h>
#include <memory>

#include "command_line.hpp"
#include "error.hpp"
#include "gnuplot.hpp"
#include "interrupt.hpp"
#include "plots.hpp"
#include "suite.hpp"

namespace fs = std::filesystem;

namespace
{

const CommandLine command_line("softshadow-bench");

struct Options {
    std::string suite, json, csv, plots, device;
    std::vector<std::pair<std::string, std::vector<std::string>>> techniques; // name and settings
    BenchOptions bench;
};

std::string suite_names()
{
    std::string names;
    for (const Suite &suite : suites())
        names += std::string(suite.name) + ", ";
    return names + "all";
}

void print_help()
{
    std::printf("softshadow-bench SUITE [--quick] [--json FILE] [--csv FILE] [--plots DIR]\n\n"
                "Measures error against Embree's ground truth, times, counts and memory, all techniques in turn in one "
                "process.\n\nsuites:\n");
    for (const Suite &suite : suites())
        std::printf("  %-12s %s\n", suite.name, suite.about);
    std::printf("  %-12s all of these\n\n", "all");
    std::printf("  --quick             smaller and shorter: well under a minute for any suite\n"
                "  --json FILE         rows, figures and claims; written after every case\n"
                "  --csv FILE          the rows as a table\n"
                "  --plots DIR         plots of the rows, SVG and PNG, by gnuplot\n"
                "  --images DIR        the picture of every row, and its error as a heat map\n"
                "  --case DIR          a case folder in place of a suite's own; may be repeated, as may the next two\n"
                "  --scene NAME        a built-in scene\n"
                "  --model FILE        a mesh file, set on a floor\n"
                "  --size WxH          size of the picture, in place of a suite's own\n"
                "  --map N             likewise, edge of the light's depth buffer in texels\n"
                "  --technique T       in place of a suite's own; may be repeated, each followed by its settings\n"
                "  --set KEY=VALUE     a setting of the --technique before it\n"
                "  --cache DIR         keeps ground truth; default: softshadow in the user's cache folder\n"
                "  --device N|NAME     default: the first GPU, else the software driver\n\n"
                "Cases from folders have no mesh: embree and average are left out there, and so are suites that change "
                "light or "
                "map.\n\n%s",
                technique_help().c_str());
}

// Where the user's programs keep what they can compute again.
std::string default_cache()
{
    const char *cache = std::getenv("XDG_CACHE_HOME"), *home = std::getenv("HOME");
    if (cache && *cache)
        return std::string(cache) + "/softshadow";
    if (home && *home)
        return std::string(home) + "/.cache/softshadow";
    return (fs::temp_directory_path() / "softshadow").string();
}

SceneCaseOptions &size_of(Options &o)
{
    if (!o.bench.size)
        o.bench.size = SceneCaseOptions{};
    return *o.bench.size;
}

void set_option(int c, Options &o)
{
    switch (c) {
    case 'q':
        o.bench.quick = true;
        break;
    case 'j':
        o.json = optarg;
        break;
    case 'v':
        o.csv = optarg;
        break;
    case 'p':
        o.plots = optarg;
        break;
    case 'i':
        o.bench.images = optarg;
        break;
    case 'c':
        o.bench.cases.push_back({CaseSource::Kind::folder, optarg});
        break;
    case 's':
        o.bench.cases.push_back({CaseSource::Kind::scene, optarg});
        break;
    case 'm':
        o.bench.cases.push_back({CaseSource::Kind::model, optarg});
        break;
    case 'z':
        command_line.size("--size", optarg, size_of(o).width, size_of(o).height);
        break;
    case 'M':
        size_of(o).map_size = command_line.whole("--map", optarg, 1, SOFTSH_MAX_EXTENT);
        break;
    case 't':
        o.techniques.push_back({optarg, {}});
        break;
    case 'k':
        if (o.techniques.empty())
            command_line.error("--set needs a --technique before it");
        o.techniques.back().second.push_back(optarg);
        break;
    case 'C':
        o.bench.cache = optarg;
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

Options parse(int argc, char **argv)
{
    static const option long_options[] = {{"quick", no_argument, nullptr, 'q'},
                                          {"json", required_argument, nullptr, 'j'},
                                          {"csv", required_argument, nullptr, 'v'},
                                          {"plots", required_argument, nullptr, 'p'},
                                          {"images", required_argument, nullptr, 'i'},
                                          {"case", required_argument, nullptr, 'c'},
                                          {"scene", required_argument, nullptr, 's'},
                                          {"model", required_argument, nullptr, 'm'},
                                          {"size", required_argument, nullptr, 'z'},
                                          {"map", required_argument, nullptr, 'M'},
                                          {"technique", required_argument, nullptr, 't'},
                                          {"set", required_argument, nullptr, 'k'},
                                          {"cache", required_argument, nullptr, 'C'},
                                          {"device", required_argument, nullptr, 'd'},
                                          {"help", no_argument, nullptr, 'h'},
                                          {nullptr, 0, nullptr, 0}};
    Options o;
    o.bench.cache = default_cache();
    for (int c; (c = getopt_long(argc, argv, "", long_options, nullptr)) != -1;)
        set_option(c, o);
    if (argc - optind != 1)
        command_line.error("expected one suite of: " + suite_names());
    o.suite = argv[optind];
    const auto is_suite = [&](const Suite &suite) { return o.suite == suite.name; };
    if (o.suite != "all" && std::none_of(suites().begin(), suites().end(), is_suite))
        command_line.error("unknown suite \"" + o.suite + "\", expected one of: " + suite_names());
    try {
        for (const auto &[name, settings] : o.techniques)
            o.bench.techniques.push_back(parse_technique(name, settings));
    } catch (const Error &error) {
        command_line.error(error.what());
    }
    return o;
}

// What would only be found after minutes is found now.
void check_inputs_and_outputs(const Options &o)
{
    for (const CaseSource &source : o.bench.cases) {
        if (source.kind == CaseSource::Kind::scene)
            make_scene(source.name);
        else if (source.kind == CaseSource::Kind::model)
            make_model_scene(source.name);
        else
            load_case(source.name);
    }
    if (!o.plots.empty())
        check_gnuplot();
    for (const std::string &folder : {o.plots, o.bench.images})
        if (!folder.empty())
            check_writable_folder(folder, "probe");
    if (!o.bench.cache.empty())
        check_writable_folder(o.bench.cache, "probe");
}

void run(const Options &o, gpu &g, Report &report)
{
    Progress progress;
    Bench bench(g, report, progress, o.bench);
    for (const Suite &suite : suites())
        if (o.suite == "all" || o.suite == suite.name)
            suite.run(bench);
    report.complete = true;
    progress.clear();
}

void print_figures(const Report &report)
{
    for (const Figure &figure : report.figures) {
        char value[32] = "-";
        if (figure.value)
            std::snprintf(value, sizeof value, "%.4g", *figure.value);
        std::printf("%-46s %-20s %10s  %s\n", figure.name.c_str(), figure.case_name.c_str(), value,
                    figure.about.c_str());
    }
    for (const Claim &claim : report.claims)
        std::printf("%-4s %-14s %s%s%s\n", claim.id.c_str(),
                    !claim.reproduced   ? "not tried"
                    : *claim.reproduced ? "reproduced"
                                        : "not reproduced",
                    claim.measured.c_str(), claim.measured.empty() || claim.why.empty() ? "" : " ", claim.why.c_str());
}

} // namespace

int main(int argc, char **argv)
{
    const Options options = parse(argc, argv);
    const auto g = std::make_unique<gpu>();
    int status = 0;
    try {
        Report report(options.json, options.csv);
        report.suite = options.suite;
        report.quick = options.bench.quick;
        check_inputs_and_outputs(options);
        gpu_info info{};
        info.device = options.device.empty() ? nullptr : options.device.c_str();
        if (!gpu_create(&info, g.get()))
            fail("%s", g->error);
        catch_interrupts();
        try {
            run(options, *g, report);
        } catch (const Interrupted &) {
            std::fprintf(stderr, "softshadow-bench: interrupted; %zu rows measured so far are kept\n",
                         report.rows.size());
            status = 130;
        }
        print_figures(report);
        report.write();
        if (!options.plots.empty())
            write_plots(report, options.plots);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "softshadow-bench: %s\n", error.what());
        status = 1;
    }
    gpu_destroy(g.get());
    return status;
}
