// Measures techniques on a case, in turn and in one process, so that ratios hold on a machine that does other things
// too.
#include "bench.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "error.hpp"
#include "interrupt.hpp"
#include "library_context.hpp"

namespace fs = std::filesystem;

namespace
{

// A technique on a case between its first run and its last.
struct Contestant {
    Row row;
    std::unique_ptr<Estimator> estimator;
    uint32_t rounds = 0;
    std::vector<RunTimes> runs;
};

bool needs_mesh(const Technique &technique)
{
    return technique.kind != TechniqueKind::library && technique.kind != TechniqueKind::dispatch;
}

// Device timestamps are the driver's word; the host's clock holds them to it.
void warn_of_lost_time(const Row &row)
{
    if (row.times && row.times->wall > 2.0 && row.times->total < 0.1 * row.times->wall)
        std::fprintf(stderr, "softshadow-bench: %s: the device says %.3f ms where the host waited %.3f ms\n",
                     describe(row.technique).c_str(), row.times->total, row.times->wall);
}

// Suites measure the same techniques on the same cases with other maps and lights.
std::string file_name(const Row &row, const std::string &what)
{
    std::string name = row.suite + "-" + row.case_name + "-" + std::to_string(row.width) +
                       (row.variant.empty() ? "" : "-" + row.variant) + "-" + what;
    for (char &c : name)
        if (c == ' ' || c == '/' || c == '=')
            c = c == '=' ? '_' : '-';
    return name;
}

} // namespace

Technique technique_of(const std::string &text)
{
    std::istringstream words(text);
    std::string name, word;
    words >> name;
    std::vector<std::string> settings;
    while (words >> word)
        settings.push_back(word);
    return parse_technique(name, settings);
}

Bench::Bench(gpu &g, Report &report, Progress &progress, const BenchOptions &options)
    : gpu_(g), report_(report), progress_(progress), options_(options)
{
}

void Bench::begin_suite(const std::string &name, size_t steps)
{
    suite_ = name;
    steps_ = std::max<size_t>(steps, 1);
    done_ = 0;
    progress_.show(name);
}

std::vector<CaseSource> Bench::cases(const std::vector<std::string> &scenes) const
{
    if (!options_.cases.empty())
        return options_.cases;
    std::vector<CaseSource> sources;
    for (const std::string &name : scenes)
        sources.push_back({CaseSource::Kind::scene, name});
    return sources;
}

std::vector<Technique> Bench::techniques(const std::vector<std::string> &names) const
{
    if (!options_.techniques.empty())
        return options_.techniques;
    std::vector<Technique> list;
    for (const std::string &name : names)
        list.push_back(technique_of(name));
    return list;
}

std::unique_ptr<BenchCase> Bench::load(const CaseSource &source, const SceneCaseOptions &size, uint32_t rays,
                                       const SceneOptions &scene)
{
    if (source.kind == CaseSource::Kind::scene)
        return load(make_scene(source.name, scene), size, rays);
    if (source.kind == CaseSource::Kind::model)
        return load(make_model_scene(source.name, scene), size, rays);
    auto result = std::make_unique<BenchCase>();
    result->data = load_case(source.name);
    result->device = std::make_unique<DeviceCase>(gpu_, result->data);
    return result;
}

std::unique_ptr<BenchCase> Bench::load(Scene scene, const SceneCaseOptions &size, uint32_t rays)
{
    check_interrupted();
    auto result = std::make_unique<BenchCase>();
    result->scene = std::move(scene);
    SceneCaseOptions chosen = options_.size.value_or(size);
    chosen.layers = size.layers; // what a suite needs, which --size and --map do not say
    chosen.sublights = size.sublights;
    result->data = render_case(gpu_, *result->scene, chosen);
    if (rays) {
        Progress tracing; // its own line: the first time it can take longer than the suite
        tracing.show("ground truth of " + result->data.name);
        add_truth(result->data, *result->scene, rays, options_.cache, tracing);
        tracing.clear();
    }
    result->device = std::make_unique<DeviceCase>(gpu_, result->data, &*result->scene);
    return result;
}

std::vector<Row> Bench::measure(BenchCase &bench_case, const std::vector<Technique> &techniques, const Effort &effort,
                                const std::string &variant)
{
    const Case &data = bench_case.data;
    std::vector<Contestant> contestants;
    const double n = static_cast<double>(std::max<size_t>(techniques.size(), 1));

    for (const Technique &technique : techniques) {
        check_interrupted();
        if (needs_mesh(technique) && !bench_case.scene)
            continue;
        show(0.5 * static_cast<double>(contestants.size()) / n);
        Contestant c;
        c.row = make_row(gpu_, data, technique);
        c.row.suite = suite_;
        c.row.variant = variant;
        // The first run counts, generates code, and makes the picture.
        std::unique_ptr<Estimator> first;
        try {
            first = make_estimator(gpu_, *bench_case.device, technique, true);
        } catch (const LimitError &error) {
            progress_.clear();
            std::fprintf(stderr, "softshadow-bench: left out %s: %s\n", describe(technique).c_str(), error.what());
            continue;
        }
        RunTimes times = timed_run(*first);
        const FloatImage result = first->visibility();
        softsh_stats stats{};
        if (first->stats(stats))
            c.row.stats = stats;
        if (technique.kind == TechniqueKind::library || needs_mesh(technique))
            c.row.memory = first->memory();
        if (data.truth)
            c.row.error = measure_error(result, *data.truth, data.mask ? &*data.mask : nullptr);
        if (!options_.images.empty())
            write_pictures(bench_case, c.row, result);
        if (effort.rounds > 0) {
            if (technique.kind == TechniqueKind::library) {
                first.reset(); // counting costs time, so a second one is timed
                first = make_estimator(gpu_, *bench_case.device, technique, false);
                times = timed_run(*first);
                // That generated code, too: what seems to take long is timed again, unless it really does.
                const double seconds = times.wall_ms * 1e-3;
                if (seconds * effort.rounds > effort.seconds && seconds < 2.0 * effort.seconds)
                    times = timed_run(*first);
            }
            const double affordable = effort.seconds * 1e3 / std::max(times.wall_ms, 1e-3);
            c.rounds = static_cast<uint32_t>(std::clamp(affordable, 1.0, static_cast<double>(effort.rounds)));
            // What generates next to no code and takes this long need not run again.
            if (needs_mesh(technique) && affordable < 1.0) {
                c.runs.push_back(times);
                c.rounds = 0;
            }
            c.estimator = std::move(first);
        }
        contestants.push_back(std::move(c));
    }
    for (uint32_t round = 0; round < effort.rounds; round++)
        for (Contestant &c : contestants) {
            check_interrupted();
            show(0.5 + 0.5 * static_cast<double>(round) / effort.rounds);
            // Fewer rounds are spread over all of them.
            if ((round + 1) * c.rounds / effort.rounds > round * c.rounds / effort.rounds)
                c.runs.push_back(timed_run(*c.estimator, effort.build));
        }
    std::vector<Row> rows;
    for (Contestant &c : contestants) {
        c.row.times = summarise(c.runs);
        warn_of_lost_time(c.row);
        rows.push_back(c.row);
        add(std::move(c.row));
    }
    step();
    report_.write();
    return rows;
}

void Bench::add(Row row)
{
    progress_.clear();
    row.suite = suite_;
    std::printf("%s\n", to_line(row).c_str());
    std::fflush(stdout);
    report_.rows.push_back(std::move(row));
}

void Bench::step()
{
    done_++;
    show(0.0);
}

void Bench::show(double part)
{
    progress_.fraction(std::min(1.0, (static_cast<double>(done_) + part) / static_cast<double>(steps_)));
}

void Bench::write_pictures(const BenchCase &bench_case, const Row &row, const FloatImage &result) const
{
    const Case &data = bench_case.data;
    const fs::path base = fs::path(options_.images) / file_name(row, describe(row.technique));
    write_png(base.string() + ".png", grey_image(result));
    if (!data.truth)
        return;
    write_png(base.string() + "-error.png", heat_map(result, *data.truth, data.mask ? &*data.mask : nullptr));
    write_png((fs::path(options_.images) / (file_name(row, "truth") + ".png")).string(), grey_image(*data.truth));
}
