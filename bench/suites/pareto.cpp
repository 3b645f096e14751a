// What a millisecond buys: every technique and its useful settings on the same receivers, and who is on the front.
#include <algorithm>
#include <cmath>

#include "suite.hpp"

namespace
{

struct Size {
    const char *scene;
    uint32_t width, height;
};

const std::vector<std::string> contestants = {
    "copy",
    "hard",
    "pcf",
    "pcss",
    "pcss blockers=64 taps=256",
    "pcss blockers=8 taps=16 near=fit",
    "pcss near=fit",
    "pcss blockers=32 taps=64 near=fit",
    "march samples=4 near=fit",
    "march samples=16",
    "march samples=16 near=fit",
    "march samples=32 steps=8 near=fit",
    "march samples=64 near=fit",
    "average samples=16",
    "average samples=64",
    "average samples=256",
    "embree samples=16",
    "embree samples=64",
    "embree samples=256",
    "area layers=1 primitive=micropatch",
    "bitmask layers=1 primitive=micropatch budget=8",
    "bitmask layers=1 primitive=micropatch budget=16",
    "bitmask layers=1 primitive=micropatch budget=32",
    "bitmask layers=1 primitive=micropatch",
    "bitmask layers=1 primitive=micropatch pattern=8x8 budget=8",
    "bitmask layers=1 primitive=micropatch budget=16 sparse=on",
    "bitmask layers=1 primitive=microquad budget=16",
    "bitmask layers=1 primitive=microquad",
    "bitmask layers=1 outline=on budget=16",
    "bitmask layers=1 outline=on",
    "bitmask layers=2 outline=on budget=32 sparse=on",
    "contour layers=1 budget=8",
    "contour layers=1 budget=16",
    "contour layers=1 budget=32",
    "contour layers=1",
    "contour layers=1 reconstruction=folds",
    "contour reconstruction=folds budget=32",
    "contour layers=1 budget=8 sparse=on",
    "contour layers=1 budget=12 sparse=on",
    "contour layers=1 budget=16 sparse=on",
    "contour layers=1 budget=12 sparse=on accel=hsm",
    "contour layers=1 sparse=on",
    "auto layers=1",
    "auto",
};

const std::vector<std::string> quick_contestants = {
    "copy",
    "hard",
    "pcf",
    "pcss",
    "pcss near=fit",
    "march samples=16",
    "average samples=16",
    "embree samples=16",
    "bitmask layers=1 primitive=micropatch budget=8",
    "bitmask layers=1 primitive=micropatch budget=16",
    "bitmask layers=1 primitive=microquad budget=16",
    "contour layers=1 budget=8 sparse=on",
    "contour layers=1 budget=16",
    "contour layers=1 budget=16 sparse=on",
    "auto",
};

bool comparable(const Row &row)
{
    return row.times && row.error && row.technique.name != "copy"; // copy is the floor, not a shadow
}

bool dominates(const Row &a, const Row &b)
{
    const bool no_worse = a.times->total <= b.times->total && a.error->mae <= b.error->mae;
    return no_worse && (a.times->total < b.times->total || a.error->mae < b.error->mae);
}

void mark_front(std::vector<Row *> &rows)
{
    for (Row *row : rows)
        row->front = std::none_of(rows.begin(), rows.end(), [&](const Row *other) { return dominates(*other, *row); });
}

// The rows of this suite from `first` on that can be compared.
std::vector<Row *> comparable_rows(Report &report, size_t first)
{
    std::vector<Row *> rows;
    for (size_t i = first; i < report.rows.size(); i++)
        if (comparable(report.rows[i]))
            rows.push_back(&report.rows[i]);
    return rows;
}

bool is_ours(const Row &row)
{
    return row.technique.kind == TechniqueKind::library;
}

std::string case_label(const Row &row)
{
    return row.case_name + " " + std::to_string(row.width) + "x" + std::to_string(row.height);
}

// A point of PCSS, and ours against it: error within its time, time to its error. `name` is how the figures start.
void add_mark(Report &report, const std::vector<Row *> &rows, const std::string &technique, const std::string &name)
{
    const auto pcss =
        std::find_if(rows.begin(), rows.end(), [&](const Row *row) { return describe(row->technique) == technique; });
    if (pcss == rows.end())
        return;
    const std::string label = case_label(**pcss);
    const double time = (*pcss)->times->total, error = (*pcss)->error->mae;
    report.figures.push_back({name + "_error", label, error, technique});
    report.figures.push_back({name + "_ms", label, time, technique});
    const auto best = [&](auto allowed, auto value) {
        const Row *found = nullptr;
        for (const Row *row : rows)
            if (is_ours(*row) && allowed(*row) && (!found || value(*row) < value(*found)))
                found = row;
        return found;
    };
    const auto error_of = [](const Row &row) { return row.error->mae; };
    const auto time_of = [](const Row &row) { return row.times->total; };
    const auto add = [&](const std::string &figure, const Row *row, double value, const char *none) {
        report.figures.push_back(
            {figure, label, row ? std::optional<double>(value) : std::nullopt, row ? describe(row->technique) : none});
    };
    for (const int factor : {1, 3}) {
        const Row *row = best([&](const Row &r) { return r.times->total <= factor * time; }, error_of);
        const std::string within = factor == 1 ? name + "_time" : "3_" + name + "_times";
        const char *none = "no setting of the library is that fast here";
        add("best_error_within_" + within, row, row ? row->error->mae : 0, none);
        add("best_error_within_" + within + "_over_" + name + "_error", row, row ? row->error->mae / error : 0, none);
    }
    for (const int divisor : {1, 3, 4}) {
        const Row *row = best([&](const Row &r) { return r.error->mae * divisor <= error; }, time_of);
        const std::string goal = divisor == 1 ? name + "_error" : name + "_error_over_" + std::to_string(divisor);
        const char *none = "no setting of the library is that accurate here";
        add("least_ms_for_" + goal, row, row ? row->times->total : 0, none);
        add("least_time_for_" + goal + "_over_" + name + "_time", row, row ? row->times->total / time : 0, none);
    }
}

// Embree's points, and our least time for the same error.
void add_embree(Report &report, const std::vector<Row *> &rows)
{
    for (const Row *embree : rows) {
        if (embree->technique.name != "embree")
            continue;
        const std::string label = case_label(*embree), name = describe(embree->technique);
        report.figures.push_back({"embree_error", label, embree->error->mae, name});
        report.figures.push_back({"embree_ms", label, embree->times->total, name});
        const Row *found = nullptr;
        for (const Row *row : rows)
            if (is_ours(*row) && row->error->mae <= embree->error->mae &&
                (!found || row->times->total < found->times->total))
                found = row;
        report.figures.push_back(
            {"embree_time_over_ours_at_its_error", label,
             found ? std::optional<double>(embree->times->total / found->times->total) : std::nullopt,
             found ? name + " against " + describe(found->technique)
                   : name + ": no setting of the library is that accurate here"});
    }
}

// Techniques that ran on every case: mean error, and the geometric mean of time over PCSS's.
void add_overall(Bench &bench, size_t first)
{
    std::map<std::string, std::vector<const Row *>> by_technique;
    std::map<std::string, double> pcss;
    for (const Row *row : comparable_rows(bench.report(), first)) {
        by_technique[describe(row->technique)].push_back(row);
        if (describe(row->technique) == "pcss")
            pcss[case_label(*row)] = row->times->total;
    }
    std::vector<Row> overall;
    for (const auto &[name, rows] : by_technique) {
        if (rows.size() != pcss.size() || pcss.size() < 2)
            continue;
        double error = 0, log_ratio = 0;
        for (const Row *row : rows) {
            error += row->error->mae / static_cast<double>(rows.size());
            log_ratio += std::log(row->times->total / pcss.at(case_label(*row))) / static_cast<double>(rows.size());
        }
        Row row;
        row.case_name = "all cases";
        row.device = rows[0]->device;
        row.driver = rows[0]->driver;
        row.technique = rows[0]->technique;
        row.measures = {{"mean_error", error}, {"time_over_pcss", std::exp(log_ratio)}};
        overall.push_back(row);
    }
    for (Row &row : overall) {
        row.front = std::none_of(overall.begin(), overall.end(), [&](const Row &other) {
            return other.measures.at("mean_error") < row.measures.at("mean_error") &&
                   other.measures.at("time_over_pcss") < row.measures.at("time_over_pcss");
        });
        bench.add(row);
    }
}

} // namespace

void run_pareto(Bench &bench)
{
    std::vector<Size> sizes = {{"balls", 640, 480}, {"fence", 640, 480}, {"contact", 640, 480}, {"balls", 1280, 1024}};
    if (bench.quick())
        sizes = {{"balls", 160, 120}};
    const std::vector<Technique> techniques = bench.techniques(bench.quick() ? quick_contestants : contestants);
    const Effort effort = bench.quick() ? Effort{3, 0.5} : Effort{5, 1.5};
    const uint32_t rays = bench.quick() ? 256 : 1024;
    const size_t first = bench.report().rows.size();

    std::vector<std::pair<CaseSource, SceneCaseOptions>> work;
    if (bench.options().cases.empty())
        for (const Size &size : sizes)
            work.push_back({{CaseSource::Kind::scene, size.scene}, {size.width, size.height, 0, 2}});
    for (const CaseSource &source : bench.options().cases)
        work.push_back({source, {bench.quick() ? 160u : 640u, bench.quick() ? 120u : 480u, 0, 2}});

    bench.begin_suite("pareto", work.size());
    for (const auto &[source, size] : work) {
        const auto bench_case = bench.load(source, size, rays);
        const size_t begin = bench.report().rows.size();
        bench.measure(*bench_case, techniques, effort);
        std::vector<Row *> rows = comparable_rows(bench.report(), begin);
        mark_front(rows);
        add_mark(bench.report(), rows, "pcss", "pcss");
        add_mark(bench.report(), rows, "pcss near=fit", "fitted_pcss");
        add_embree(bench.report(), rows);
        bench.report().write();
    }
    add_overall(bench, first);
}
