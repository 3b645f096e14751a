// softshadow-eval: one technique on one case, its error against the case's truth, its time and its counts.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <getopt.h>

#include "command_line.hpp"
#include "error.hpp"
#include "row.hpp"

namespace
{

struct Options {
    std::string case_dir, technique = "auto", against, out, json, device;
    std::vector<std::string> settings;
    int repeat = 5;
};

void print_help()
{
    std::printf(
        "softshadow-eval CASE_DIR [--technique T] [--set K=V ...] [--repeat N] [--out DIR] [--json FILE]\n"
        "                [--against T] [--device N|NAME]\n\n"
        "Runs one technique (default: auto) on a case: a folder with case.json and depth buffers as EXR files.\n"
        "Prints error against the case's truth and the median time of N runs (default 5; 0: one, not timed).\n"
        "--out writes visibility.exr, visibility.png and, with a truth, error.png (0 to 0.5); --json the row.\n"
        "--against times a second technique (without settings) in turn with the first and prints the ratio of the "
        "times\n"
        "that do not include the build.\n\n%s",
        technique_help().c_str());
}

const CommandLine command_line("softshadow-eval");

Options parse(int argc, char **argv)
{
    static const option long_options[] = {{"technique", required_argument, nullptr, 't'},
                                          {"set", required_argument, nullptr, 's'},
                                          {"repeat", required_argument, nullptr, 'r'},
                                          {"out", required_argument, nullptr, 'o'},
                                          {"json", required_argument, nullptr, 'j'},
                                          {"against", required_argument, nullptr, 'a'},
                                          {"device", required_argument, nullptr, 'd'},
                                          {"help", no_argument, nullptr, 'h'},
                                          {nullptr, 0, nullptr, 0}};
    Options o;
    for (int c; (c = getopt_long(argc, argv, "", long_options, nullptr)) != -1;) {
        switch (c) {
        case 't':
            o.technique = optarg;
            break;
        case 's':
            o.settings.push_back(optarg);
            break;
        case 'r':
            o.repeat = static_cast<int>(command_line.whole("--repeat", optarg, 0, 10000));
            break;
        case 'o':
            o.out = optarg;
            break;
        case 'j':
            o.json = optarg;
            break;
        case 'a':
            o.against = optarg;
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
        command_line.error("expected one case folder");
    o.case_dir = argv[optind];
    return o;
}

void write_images(const Options &o, const Case &data, const FloatImage &result)
{
    std::error_code error;
    std::filesystem::create_directories(o.out, error);
    if (error)
        fail("%s: cannot be created: %s", o.out.c_str(), error.message().c_str());
    write_exr(o.out + "/visibility.exr", result);
    write_png(o.out + "/visibility.png", grey_image(result));
    if (data.truth)
        write_png(o.out + "/error.png", heat_map(result, *data.truth, data.mask ? &*data.mask : nullptr));
}

void print_ratio(const Row &row, Row other, const std::vector<RunTimes> &runs)
{
    other.times = summarise(runs);
    std::printf("%s %.3f ms / %s %.3f ms = %.2f (medians of %zu, in turn, without the build)\n",
                describe(row.technique).c_str(), row.times->visibility, describe(other.technique).c_str(),
                other.times->visibility, row.times->visibility / other.times->visibility, runs.size());
}

void run(const Options &o, gpu &g)
{
    const Technique technique = parse_technique(o.technique, o.settings);
    const Case data = load_case(o.case_dir);
    DeviceCase device_case(g, data);
    Row row = make_row(g, data, technique);
    const auto counting = make_estimator(g, device_case, technique, true);
    counting->run();
    const FloatImage result = counting->visibility();
    softsh_stats stats{};
    if (counting->stats(stats))
        row.stats = stats;
    if (technique.kind == TechniqueKind::library)
        row.memory = counting->memory();
    if (data.truth)
        row.error = measure_error(result, *data.truth, data.mask ? &*data.mask : nullptr);
    if (o.repeat > 0) {
        const auto timed = make_estimator(g, device_case, technique, false);
        const auto other =
            o.against.empty() ? nullptr : make_estimator(g, device_case, parse_technique(o.against, {}), false);
        timed->run(); // code is generated at the first dispatch
        if (other)
            other->run();
        std::vector<RunTimes> runs, other_runs;
        for (int i = 0; i < o.repeat; i++) {
            runs.push_back(timed_run(*timed));
            if (other)
                other_runs.push_back(timed_run(*other));
        }
        row.times = summarise(runs);
        if (other)
            print_ratio(row, make_row(g, data, parse_technique(o.against, {})), other_runs);
    }
    std::printf("%s\n", to_line(row).c_str());
    if (!o.out.empty())
        write_images(o, data, result);
    if (!o.json.empty()) {
        std::ofstream file(o.json);
        file << to_json(row);
        file.close();
        if (!file)
            fail("%s: cannot be written", o.json.c_str());
    }
}

} // namespace

int main(int argc, char **argv)
{
    const Options options = parse(argc, argv);
    gpu g{};
    try {
        gpu_info info{};
        info.device = options.device.empty() ? nullptr : options.device.c_str();
        parse_technique(options.technique, options.settings); // before anything takes time
        if (!options.against.empty())
            parse_technique(options.against, {});
        if (!gpu_create(&info, &g))
            fail("%s", g.error);
        run(options, g);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "softshadow-eval: %s\n", error.what());
        gpu_destroy(&g);
        return 1;
    }
    gpu_destroy(&g);
    return 0;
}
