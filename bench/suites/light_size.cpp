// Time, visited nodes and error over the light's width, from a point to larger than the occluder; and how they grow.
#include <map>

#include "suite.hpp"
#include "sweep.hpp"

void run_light_size(Bench &bench)
{
    // The balls' spheres are 0.9 wide, the post 0.3.
    std::vector<double> sizes = {0.0, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2, 6.4};
    std::vector<std::string> scenes = {"balls", "post"};
    SceneCaseOptions size{320, 240, 512, 1};
    uint32_t rays = 256;
    Effort effort{5, 0.6};
    std::vector<std::string> names = {
        "copy",
        "hard",
        "pcss",
        "march samples=16",
        "embree samples=64",
        "area primitive=micropatch",
        "bitmask primitive=micropatch",
        "bitmask primitive=microquad",
        "bitmask outline=on",
        "bitmask primitive=micropatch budget=16",
        "contour",
        "auto",
    };
    if (bench.quick()) {
        sizes = {0.0, 0.4, 1.6};
        scenes = {"balls"};
        size = {160, 120, 256, 1};
        rays = 64;
        effort = {3, 0.3};
        names = {"copy", "pcss", "area primitive=micropatch", "bitmask primitive=micropatch", "contour", "auto"};
    }
    const std::vector<CaseSource> sources = bench.cases(scenes);
    const std::vector<Technique> techniques = bench.techniques(names);
    bench.begin_suite("light-size", sources.size() * sizes.size());
    for (const CaseSource &source : sources) {
        if (source.kind == CaseSource::Kind::folder)
            continue; // its light is what it is
        // Points of (light width, figure), of lights wide enough that their kernels span several texels.
        std::map<std::string, std::vector<std::pair<double, double>>> time, pixel_time, primitives;
        std::string name;
        for (const double width : sizes) {
            SceneOptions scene;
            scene.light_size = width;
            const auto bench_case = bench.load(source, size, rays, scene);
            char variant[64];
            std::snprintf(variant, sizeof variant, "light %g", width);
            name = bench_case->data.name;
            for (const Row &row : bench.measure(*bench_case, techniques, effort, variant)) {
                if (width < sizes.back() / 16.0)
                    continue;
                const std::string key = describe(row.technique);
                time[key].emplace_back(width, row.times->visibility);
                if (!row.stats || !row.stats->active)
                    continue;
                const double active = static_cast<double>(row.stats->active);
                pixel_time[key].emplace_back(width, stage_ms(row, "evaluate").value_or(0.0) / active);
                primitives[key].emplace_back(width, static_cast<double>(row.stats->primitives) / active);
            }
        }
        for (const auto &[key, points] : time)
            bench.report().figures.push_back({"growth_of_time_with_light_width", name, growth_exponent(points), key});
        for (const auto &[key, points] : pixel_time)
            bench.report().figures.push_back(
                {"growth_of_time_per_active_pixel_with_light_width", name, growth_exponent(points), key});
        for (const auto &[key, points] : primitives)
            bench.report().figures.push_back(
                {"growth_of_primitives_per_active_pixel_with_light_width", name, growth_exponent(points), key});
    }
}
