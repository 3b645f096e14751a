// What the acceleration structures cost: time and memory of HSM, MSSM and YSM over the map's size.
#include <map>

#include "suite.hpp"

void run_build(Bench &bench)
{
    std::vector<uint32_t> maps = {256, 512, 1024, 2048};
    Effort effort{7, 2.0};
    if (bench.quick()) {
        maps = {256, 512};
        effort = {3, 0.3};
    }
    // Pixels are few and cheap: this is about the build.
    const std::vector<Technique> techniques = bench.techniques({
        "bitmask primitive=micropatch budget=8 accel=hsm",
        "bitmask primitive=micropatch budget=8 accel=ysm",
        "bitmask primitive=micropatch budget=8 accel=mssm",
    });
    const std::vector<CaseSource> sources = bench.cases({"balls"});
    bench.begin_suite("build", sources.size() * maps.size());
    for (const CaseSource &source : sources) {
        for (const uint32_t map : maps) {
            if (source.kind == CaseSource::Kind::folder && map != maps.front())
                continue; // its map is what it is
            const auto bench_case = bench.load(source, {160, 120, map, 1}, 0);
            std::map<std::string, double> build;
            std::string label;
            for (const Row &row : bench.measure(*bench_case, techniques, effort, "map " + std::to_string(map))) {
                build[row.technique.settings.count("accel") ? row.technique.settings.at("accel") : ""] =
                    row.times->build;
                label = row.case_name + " map " + std::to_string(row.map_size);
            }
            if (!(build["hsm"] > 0.0))
                continue;
            for (const char *accel : {"ysm", "mssm"}) {
                if (!(build[accel] > 0.0))
                    continue; // more than the device can hold
                bench.report().figures.push_back({std::string("build_") + accel + "_over_hsm", label,
                                                  build[accel] / build["hsm"], "median build times in one run"});
            }
        }
    }
}
