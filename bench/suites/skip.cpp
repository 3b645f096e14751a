// What the library costs where there is nothing to do, against a pass that reads the depth and writes 1.
#include "suite.hpp"

#include <algorithm>

namespace
{

// Ratios of each technique's time to that of `copy` in the same measurement.
void add_ratios(Bench &bench, const std::vector<Row> &rows, const std::string &variant)
{
    const auto copy =
        std::find_if(rows.begin(), rows.end(), [](const Row &row) { return row.technique.name == "copy"; });
    if (copy == rows.end())
        return;
    for (const Row &row : rows) {
        if (row.technique.name == "copy")
            continue;
        const std::string name = describe(row.technique);
        bench.report().figures.push_back(
            {"time_over_copy", variant, row.times->total / copy->times->total, name + ", with the build"});
        bench.report().figures.push_back(
            {"visibility_time_over_copy", variant, row.times->visibility / copy->times->visibility, name});
    }
}

} // namespace

void run_skip(Bench &bench)
{
    SceneCaseOptions size{1280, 1024, 1024, 1};
    Effort effort{15, 2.0};
    if (bench.quick()) {
        size = {320, 240, 256, 1};
        effort = {5, 0.3};
    }
    const std::vector<Technique> techniques = bench.techniques({"copy", "hard", "pcss", "auto"});
    const CaseSource lit{CaseSource::Kind::scene, "lit"}, umbra{CaseSource::Kind::scene, "umbra"},
        balls{CaseSource::Kind::scene, "balls"};
    bench.begin_suite("skip", 6);
    const auto run = [&](BenchCase &bench_case, const std::string &variant, const Effort &how) {
        add_ratios(bench, bench.measure(bench_case, techniques, how, variant), variant);
    };

    run(*bench.load(lit, size, 0), "lit", effort);
    run(*bench.load(umbra, size, 0), "umbra", effort);

    auto empty = bench.load(lit, size, 0);
    for (CaseMap &map : empty->data.maps)
        std::fill(map.depth.texels.begin(), map.depth.texels.end(), map.frustum.reversed ? 0.0f : 1.0f);
    empty->device = std::make_unique<DeviceCase>(bench.device(), empty->data, &*empty->scene);
    run(*empty, "empty map", effort);

    Scene moved = make_scene("balls");
    const glm::dvec3 away(1000.0, 0.0, 0.0);
    moved.light.centre += away;
    moved.map.view[3] -= glm::dvec4(glm::dmat3(moved.map.view) * away, 0.0);
    run(*bench.load(std::move(moved), size, 0), "light outside", effort);

    Effort reused = effort;
    reused.build = false;
    run(*bench.load(lit, size, 0), "unchanged map", reused);

    SceneOptions point;
    point.light_size = 0.0;
    run(*bench.load(balls, size, 0, point), "light without size", effort);
}
