// Technique embree against the ground truth, which shares its receivers and its ray caster but no samples, and against
// scenes whose shadows are known.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "error.hpp"
#include "parallel.hpp"
#include "row.hpp"
#include "scene_case.hpp"
#include "truth.hpp"

namespace
{

int failures = 0;

void expect(bool ok, const std::string &what)
{
    if (!ok) {
        failures++;
        std::printf("FAILED: %s\n", what.c_str());
    }
}

// A scene, its case at a small size, and the ground truth for whatever light the case has by then.
struct Setup {
    Scene scene;
    Case data;

    Setup(gpu &g, const char *name, const SceneOptions &options = {}) : scene(make_scene(name, options))
    {
        SceneCaseOptions size;
        size.width = 96;
        size.height = 73;
        size.map_size = 64;
        data = render_case(g, scene, size);
    }
    Truth truth() const
    {
        TruthOptions options;
        options.samples = 1024;
        return compute_truth(scene.mesh, scene.origin, data.camera, data.light, options);
    }
};

FloatImage embree(gpu &g, const Setup &setup, const char *samples)
{
    DeviceCase device_case(g, setup.data, &setup.scene);
    const Technique technique = parse_technique("embree", {std::string("samples=") + samples});
    const auto estimator = make_estimator(g, device_case, technique, false);
    estimator->run();
    return estimator->visibility();
}

// The noise of 1024 stratified samples is at most 0.004 rms in the scenes here, and 1.4 times that between two of them.
void expect_truth(gpu &g, const Setup &setup, const std::string &what)
{
    const Truth truth = setup.truth();
    const FloatImage result = embree(g, setup, "1024");
    const ErrorMetric error = measure_error(result, truth.visibility, &truth.mask);
    std::printf("%s: error %.5f, rms %.5f, most %.5f of %llu pixels\n", what.c_str(), error.mae, error.rmse, error.max,
                static_cast<unsigned long long>(error.pixels));
    expect(error.pixels > 300, what + ": has shadows");
    expect(error.rmse > 0.0, what + ": other samples than the truth's");
    expect(error.rmse < 0.006, what + ": rms error within the noise");
    expect(error.max < 0.04, what + ": greatest error within the noise");
    double bias = 0.0;
    for (size_t i = 0; i < result.texels.size(); i++)
        bias += truth.mask.texels[i] * (result.texels[i] - truth.visibility.texels[i]);
    expect(std::fabs(bias) < 0.0005 * static_cast<double>(error.pixels), what + ": no bias");
}

void test_lights(gpu &g)
{
    Setup balls(g, "balls");
    expect_truth(g, balls, "rectangle");
    balls.data.light.shape = LightShape::disc;
    expect_truth(g, balls, "disc");
    balls.data.light.shape = LightShape::sphere;
    expect_truth(g, balls, "sphere");
    SceneOptions options;
    options.directional = true;
    expect_truth(g, Setup(g, "balls", options), "sun");
    options = {};
    options.world_offset = {3000.0, -200.0, 5000.0};
    expect_truth(g, Setup(g, "balls", options), "far from the world's zero");
}

void expect_everywhere(gpu &g, const char *name, float value)
{
    const Setup setup(g, name);
    const Truth truth = setup.truth();
    const FloatImage result = embree(g, setup, "64");
    size_t masked = 0, wrong = 0;
    for (size_t i = 0; i < result.texels.size(); i++)
        if (truth.mask.texels[i] > 0.5f) {
            masked++;
            wrong += result.texels[i] != value;
        }
    expect(masked > 1000, std::string(name) + ": has receivers");
    expect(wrong == 0, std::string(name) + ": " + std::to_string(wrong) + " receivers are not " +
                           std::to_string(static_cast<int>(value)));
}

void test_sample_counts(gpu &g)
{
    const Setup setup(g, "contact");
    expect(embree(g, setup, "63").texels == embree(g, setup, "49").texels, "63 samples are a grid of 7 x 7");
    expect(embree(g, setup, "64").texels == embree(g, setup, "64").texels, "the same picture every time");
    const FloatImage one = embree(g, setup, "1");
    expect(std::all_of(one.texels.begin(), one.texels.end(), [](float v) { return v == 0.0f || v == 1.0f; }),
           "one sample is all or nothing");
}

void test_estimator(gpu &g)
{
    const Setup setup(g, "contact");
    DeviceCase device_case(g, setup.data, &setup.scene);
    const auto estimator = make_estimator(g, device_case, parse_technique("embree", {}), false);
    expect(estimator->run(false).build.size() == 1, "the first run builds");
    const FloatImage before = estimator->visibility();
    expect(estimator->run(false).build.empty(), "later ones do not unless asked");
    const RunTimes times = estimator->run(true);
    expect(times.build.size() == 1 && times.build[0].name == "embree_build" && times.build[0].ms > 0.0, "build time");
    expect(times.visibility.size() == 1 && times.visibility[0].name == "embree_rays" && times.visibility[0].ms > 0.0,
           "time of the rays");
    expect(estimator->visibility().texels == before.texels, "a second build changes nothing");
    expect(estimator->memory().persistent > setup.scene.mesh.triangle_count(), "memory is known");

    DeviceCase without(g, setup.data);
    try {
        make_estimator(g, without, parse_technique("embree", {}), false);
        expect(false, "without a scene: an error");
    } catch (const Error &error) {
        expect(std::string(error.what()).find("needs the scene's mesh") != std::string::npos,
               std::string("without a scene: ") + error.what());
    }
}

void test_parallel()
{
    std::vector<std::atomic<int>> calls(1000);
    parallel_for(1000, [&](uint32_t i) { calls[i]++; });
    expect(std::all_of(calls.begin(), calls.end(), [](const std::atomic<int> &n) { return n == 1; }),
           "each index once");
    parallel_for(0, [&](uint32_t) { expect(false, "nothing to do"); });
    bool thrown = false;
    try {
        parallel_for(1000, [](uint32_t i) {
            if (i == 17)
                throw std::runtime_error("17");
        });
    } catch (const std::runtime_error &) {
        thrown = true;
    }
    expect(thrown, "exceptions come through");
}

} // namespace

int main()
{
    const auto g = std::make_unique<gpu>();
    const gpu_info info{};
    if (!gpu_create(&info, g.get())) {
        std::printf("%s\n", g->error);
        return 1;
    }
    try {
        test_parallel();
        test_lights(*g);
        expect_everywhere(*g, "lit", 1.0f);
        expect_everywhere(*g, "umbra", 0.0f);
        test_sample_counts(*g);
        test_estimator(*g);
    } catch (const std::exception &error) {
        expect(false, error.what());
    }
    gpu_destroy(g.get());
    return failures == 0 ? 0 : 1;
}
