// Time and error over the size of the picture: what a pixel costs.
#include "suite.hpp"

void run_resolution(Bench &bench)
{
    std::vector<SceneCaseOptions> sizes = {
        {160, 120, 512, 1}, {320, 240, 512, 1}, {640, 480, 512, 1}, {1280, 960, 512, 1}};
    uint32_t rays = 64; // the picture's size changes time, hardly error
    Effort effort{5, 1.5};
    std::vector<std::string> names = {
        "copy", "hard", "pcss", "bitmask primitive=micropatch budget=16", "contour budget=16 sparse=on", "auto"};
    if (bench.quick()) {
        sizes = {{80, 60, 256, 1}, {160, 120, 256, 1}, {320, 240, 256, 1}};
        rays = 16;
        effort = {3, 0.3};
    }
    const std::vector<CaseSource> sources = bench.cases({"balls"});
    const std::vector<Technique> techniques = bench.techniques(names);
    bench.begin_suite("resolution", sources.size() * sizes.size());
    for (const CaseSource &source : sources) {
        if (source.kind == CaseSource::Kind::folder)
            continue; // its depth buffers are what they are
        for (const SceneCaseOptions &size : sizes) {
            const auto bench_case = bench.load(source, size, rays);
            bench.measure(*bench_case, techniques, effort,
                          std::to_string(size.width) + "x" + std::to_string(size.height));
        }
    }
}
