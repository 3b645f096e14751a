// What moves or shows where nothing should: jumps while the light moves by fractions of a texel, and self-shadowing
// (acne) on planes under every angle.
#include "suite.hpp"

#include <algorithm>
#include <cmath>

#include "interrupt.hpp"
#include "scene_build.hpp"

namespace
{

// Of one technique, over the pixels of the mask.
struct Motion {
    std::vector<float> first, last, travel, jump; // visibility at either end, sum and largest of the changes
};

void follow(Motion &motion, const FloatImage &visibility)
{
    if (motion.first.empty()) {
        motion.first = motion.last = visibility.texels;
        motion.travel.assign(visibility.texels.size(), 0.0f);
        motion.jump = motion.travel;
        return;
    }
    for (size_t i = 0; i < visibility.texels.size(); i++) {
        const float change = std::fabs(visibility.texels[i] - motion.last[i]);
        motion.travel[i] += change;
        motion.jump[i] = std::max(motion.jump[i], change);
    }
    motion.last = visibility.texels;
}

std::map<std::string, double> summary(const Motion &motion)
{
    std::vector<float> jumps;
    double travel = 0, net = 0;
    for (size_t i = 0; i < motion.travel.size(); i++) {
        if (!(motion.travel[i] > 0.0f))
            continue;
        jumps.push_back(motion.jump[i]);
        travel += static_cast<double>(motion.travel[i]);
        net += std::fabs(static_cast<double>(motion.last[i]) - static_cast<double>(motion.first[i]));
    }
    if (jumps.empty())
        return {{"changing_pixels", 0.0}};
    std::sort(jumps.begin(), jumps.end());
    const double n = static_cast<double>(jumps.size());
    double mean = 0;
    for (const float jump : jumps)
        mean += static_cast<double>(jump) / n;
    const auto rank = [&](double q) { return static_cast<double>(jumps[static_cast<size_t>(q * (n - 1))]); };
    return {{"changing_pixels", n},
            {"mean_largest_jump", mean},
            {"p99_largest_jump", rank(0.99)},
            {"largest_jump", rank(1.0)},
            // What goes to and fro rather than along: zero for a shadow that only moves.
            {"mean_travel_to_and_fro", (travel - net) / n}};
}

// The light, and with it the map, moves along its own axis by one texel's width at the scene's middle.
void move_light(Bench &bench, const char *scene, const std::vector<Technique> &techniques, const SceneCaseOptions &size,
                int steps)
{
    const SceneOptions options;
    const Scene start = make_scene(scene, options);
    const auto bench_case = bench.load(start, size, 0);
    Case &data = bench_case->data;
    std::vector<std::unique_ptr<Estimator>> estimators;
    std::vector<Motion> motions(techniques.size());
    for (const Technique &technique : techniques)
        estimators.push_back(make_estimator(bench.device(), *bench_case->device, technique, false));

    Rasteriser rasteriser(bench.device());
    rasteriser.set_mesh(start.mesh);
    DepthTarget &target = rasteriser.create_depth_target(data.maps[0].depth.width, data.maps[0].depth.height);
    const double distance = glm::length(start.camera.target - start.light.centre);
    const double texel = 2.0 * distance * std::tan(0.5 * start.map_fov) / data.maps[0].depth.width;
    const glm::dvec3 along = glm::normalize(start.light.half_u) * texel / static_cast<double>(steps);
    for (int step = 0; step <= steps; step++) {
        check_interrupted();
        const glm::dvec3 offset = along * static_cast<double>(step);
        data.light.centre = start.light.centre + offset;
        data.maps[0].frustum = start.map;
        data.maps[0].frustum.view[3] -= glm::dvec4(glm::dmat3(start.map.view) * offset, 0.0);
        rasteriser.depth(target, data.maps[0].frustum, start.origin);
        data.maps[0].depth = read_depth(bench.device(), target.image);
        bench_case->device->upload_map(0);
        for (size_t i = 0; i < techniques.size(); i++) {
            estimators[i]->run();
            follow(motions[i], estimators[i]->visibility());
        }
        if (step % 8 == 0)
            bench.step();
    }
    for (size_t i = 0; i < techniques.size(); i++) {
        Row row = make_row(bench.device(), data, techniques[i]);
        row.variant = "light moves one texel in " + std::to_string(steps) + " steps";
        row.measures = summary(motions[i]);
        bench.add(row);
    }
}

// A square plane whose normal and the direction to the light make `degrees`.
Scene tilted_plane(double degrees)
{
    const double angle = glm::radians(degrees);
    SceneSetup s;
    s.name = "plane";
    const glm::dvec3 across(1.0, 0.0, 0.0), down(0.0, -std::sin(angle), std::cos(angle));
    s.objects = make_quad(down * 1.5, across * 1.5, glm::vec3(0.6f));
    const glm::dvec3 normal = glm::cross(down, across);
    s.camera.eye = normal * 4.0;
    s.camera.up = down;
    s.camera.fov_y = glm::radians(35.0);
    s.camera.range = {0.1, 20.0, false};
    s.light_centre = {0.0, 6.0, 0.0};
    s.light_half_u = s.light_half_v = 0.5;
    s.map_fov = glm::radians(45.0);
    s.map_size = 512;
    return finish_scene(s, {});
}

// How dark pixels are that see the whole light.
void add_acne(Bench &bench, const std::vector<Technique> &techniques, double degrees, const SceneCaseOptions &size,
              uint32_t rays)
{
    const auto bench_case = bench.load(tilted_plane(degrees), size, rays);
    const Case &data = bench_case->data;
    for (const Technique &technique : techniques) {
        const auto estimator = make_estimator(bench.device(), *bench_case->device, technique, false);
        estimator->run();
        const FloatImage result = estimator->visibility();
        double sum = 0, most = 0, pixels = 0;
        for (size_t i = 0; i < result.texels.size(); i++) {
            if (data.mask->texels[i] < 0.5f || data.truth->texels[i] < 1.0f)
                continue;
            const double dark = 1.0 - static_cast<double>(result.texels[i]);
            pixels++;
            sum += dark;
            most = std::max(most, dark);
        }
        Row row = make_row(bench.device(), data, technique);
        char variant[32];
        std::snprintf(variant, sizeof variant, "plane at %g degrees", degrees);
        row.variant = variant;
        row.measures = {{"degrees", degrees}, {"lit_pixels", pixels}};
        if (pixels > 0) {
            row.measures["mean_acne"] = sum / pixels;
            row.measures["largest_acne"] = most;
        }
        bench.add(row);
    }
    bench.step();
}

} // namespace

void run_stability(Bench &bench)
{
    std::vector<double> angles = {0, 15, 30, 45, 60, 70, 80, 85, 87, 88, 89};
    SceneCaseOptions size{320, 240, 512, 1};
    uint32_t rays = 64;
    int steps = 64;
    std::vector<std::string> names = {
        "hard",
        "pcf",
        "pcss",
        "march samples=16",
        "bitmask primitive=micropatch budget=16",
        "bitmask primitive=micropatch budget=8",
        "bitmask primitive=microquad budget=16",
        "contour budget=16",
        "contour budget=16 sparse=on",
        "contour budget=8",
        "contour budget=8 refine=off",
        "auto",
    };
    // Thin structures are where coarse samples blink.
    std::vector<const char *> scenes = {"balls", "twigs"};
    if (bench.quick()) {
        angles = {0, 45, 80, 88};
        size = {80, 60, 256, 1};
        rays = 16;
        steps = 16;
        names = {"pcss", "bitmask primitive=micropatch budget=16", "auto"};
        scenes = {"balls"};
    }
    const std::vector<Technique> techniques = bench.techniques(names);
    bench.begin_suite("stability", angles.size() + scenes.size() * static_cast<size_t>(steps / 8 + 1));
    for (const char *scene : scenes)
        move_light(bench, scene, techniques, size, steps);
    for (const double degrees : angles)
        add_acne(bench, techniques, degrees, size, rays);
}
