// Time, primitives and error over the budget.
#include "suite.hpp"

void run_budget(Bench &bench)
{
    std::vector<uint32_t> budgets = {4, 6, 8, 12, 16, 24, 32, 48, 64, 0};
    SceneCaseOptions size{640, 480, 0, 1};
    uint32_t rays = 1024;
    Effort effort{5, 1.0};
    if (bench.quick()) {
        budgets = {8, 16, 32};
        size = {160, 120, 256, 1};
        rays = 64;
        effort = {3, 0.3};
    }
    std::vector<std::string> names = {"pcss"};
    for (const char *technique : {"bitmask primitive=micropatch", "bitmask primitive=microquad", "contour"})
        for (const uint32_t budget : budgets)
            names.push_back(std::string(technique) + " budget=" + (budget ? std::to_string(budget) : "inf"));
    const std::vector<CaseSource> sources = bench.cases({"balls"});
    const std::vector<Technique> techniques = bench.techniques(names);
    bench.begin_suite("budget", sources.size());
    for (const CaseSource &source : sources) {
        const auto bench_case = bench.load(source, size, rays);
        bench.measure(*bench_case, techniques, effort);
    }
}
