// Time, memory and error over the map's size.
#include "suite.hpp"

void run_map_size(Bench &bench)
{
    std::vector<uint32_t> maps = {256, 512, 1024, 2048, 4096};
    SceneCaseOptions size{320, 240, 0, 1};
    uint32_t rays = 256;
    Effort effort{5, 1.0};
    std::vector<std::string> names = {"copy",
                                      "hard",
                                      "pcss",
                                      "march samples=16",
                                      "bitmask primitive=micropatch budget=16",
                                      "contour budget=16 sparse=on",
                                      "auto"};
    if (bench.quick()) {
        maps = {256, 512, 1024};
        size = {160, 120, 0, 1};
        rays = 64;
        effort = {3, 0.3};
    }
    const std::vector<CaseSource> sources =
        bench.cases(bench.quick() ? std::vector<std::string>{"balls"} : std::vector<std::string>{"balls", "fence"});
    const std::vector<Technique> techniques = bench.techniques(names);
    bench.begin_suite("map-size", sources.size() * maps.size());
    for (const CaseSource &source : sources) {
        if (source.kind == CaseSource::Kind::folder)
            continue; // its depth buffers are what they are
        for (const uint32_t map : maps) {
            size.map_size = map;
            const auto bench_case = bench.load(source, size, rays);
            bench.measure(*bench_case, techniques, effort, "map " + std::to_string(map));
        }
    }
}
