// The figures under regression. Nearly all of the time on the software driver goes into generating code, so all scenes
// have images of one size and pass through one set of pipelines.
#include "figures.hpp"

#include <algorithm>
#include <memory>

#include "error.hpp"
#include "row.hpp"
#include "scene_case.hpp"

namespace
{

constexpr uint32_t truth_rays = 256;
const SceneCaseOptions case_size = {160, 120, 256, 2};

struct RegressionScene {
    std::string name, scene;
    SceneOptions options;
};

std::vector<RegressionScene> scene_list()
{
    std::vector<RegressionScene> list;
    for (const SceneName &scene : scene_names())
        list.push_back({scene.name, scene.name, {}});
    SceneOptions sun;
    sun.directional = true;
    list.push_back({"contact, directional", "contact", sun});
    SceneOptions reversed;
    reversed.reversed_camera = reversed.infinite_camera = true;
    reversed.reversed_map = reversed.infinite_map = true;
    list.push_back({"contact, reversed", "contact", reversed});
    return list;
}

// Where every micro-occluder is evaluated, the large kernels of post take seconds: variants have a budget that binds
// there and in silhouette only.
std::vector<Technique> technique_list()
{
    std::vector<Technique> list = {
        parse_technique("auto", {}),
        parse_technique("auto", {"layers=1"}),
        parse_technique("bitmask", {"primitive=micropatch", "pattern=16x16j"}),
        parse_technique("bitmask", {"primitive=microquad", "pattern=16x16j"}),
        parse_technique("bitmask", {"primitive=micropatch", "budget=16"}),
        parse_technique("bitmask", {"outline=on", "budget=32"}),
        parse_technique("contour", {"reconstruction=folds", "budget=32"}),
        parse_technique("area", {"primitive=micropatch", "budget=32"}),
        parse_technique("contour", {"budget=16"}),
        parse_technique("contour", {"budget=16", "layers=1"}),
        parse_technique("contour", {"budget=16", "layers=1", "sparse=on"}),
        parse_technique("contour", {"budget=16", "layers=1", "search=walk"}),
    };
    for (const char *variant : {"accel=hsm", "accel=mssm", "hierarchy=off", "filter=2", "merge=max"})
        list.push_back(parse_technique("bitmask", {"primitive=micropatch", "budget=32", variant}));
    for (const char *peer : {"hard", "pcf", "pcss"})
        list.push_back(parse_technique(peer, {}));
    return list;
}

bool contains(const std::vector<std::string> &list, const std::string &name)
{
    return std::find(list.begin(), list.end(), name) != list.end();
}

// One case after another on the same images, so that estimators can stay.
class Stage
{
  public:
    Stage(gpu &g, std::vector<Technique> techniques)
        : gpu_(g), techniques_(std::move(techniques)), estimators_(techniques_.size())
    {
    }

    void enter(Case data)
    {
        data_ = std::move(data);
        if (!device_case_) {
            device_case_ = std::make_unique<DeviceCase>(gpu_, data_);
            return;
        }
        for (size_t i = 0; i < data_.maps.size(); i++)
            device_case_->upload_map(i);
        const FloatImage &depth = data_.camera.depth;
        if (!gpu_image_upload(&gpu_, &device_case_->camera, depth.texels.data(), depth.texels.size() * sizeof(float),
                              VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL))
            fail("%s", gpu_.error);
    }

    std::map<std::string, double> measure(size_t technique)
    {
        std::unique_ptr<Estimator> &estimator = estimators_[technique];
        // Peers are made for one shape of light.
        if (!estimator || techniques_[technique].kind != TechniqueKind::library)
            estimator = make_estimator(gpu_, *device_case_, techniques_[technique], true);
        estimator->run();
        return figures_of(*estimator);
    }

  private:
    std::map<std::string, double> figures_of(Estimator &estimator) const
    {
        const ErrorMetric error = measure_error(estimator.visibility(), *data_.truth, &*data_.mask);
        std::map<std::string, double> figures;
        figures["mae"] = error.mae;
        figures["rmse"] = error.rmse;
        figures["error_pixels"] = static_cast<double>(error.pixels);
        figures["p99"] = error.p99; // not the largest: one pixel decides that
        softsh_stats stats{};
        if (!estimator.stats(stats))
            return figures; // a peer: it counts nothing, and its memory is not the library's
        figures["lit"] = static_cast<double>(stats.lit);
        figures["umbra"] = static_cast<double>(stats.umbra);
        figures["active"] = static_cast<double>(stats.active);
        figures["nodes"] = static_cast<double>(stats.nodes);
        figures["primitives"] = static_cast<double>(stats.primitives);
        figures["tiles"] = static_cast<double>(stats.tiles);
        figures["undecided_tiles"] = static_cast<double>(stats.undecided_tiles);
        figures["clamped"] = static_cast<double>(stats.clamped);
        figures["interpolated"] = static_cast<double>(stats.interpolated);
        figures["wide_levels_built"] = stats.wide_levels_built;
        figures["wide_levels_skipped"] = stats.wide_levels_skipped;
        const MemoryUse memory = estimator.memory();
        figures["persistent_bytes"] = static_cast<double>(memory.persistent);
        figures["transient_bytes"] = static_cast<double>(memory.transient);
        return figures;
    }

    gpu &gpu_;
    const std::vector<Technique> techniques_;
    Case data_;
    std::unique_ptr<DeviceCase> device_case_;
    std::vector<std::unique_ptr<Estimator>> estimators_; // as techniques_; made when first used
};

} // namespace

Selection all_figures()
{
    Selection all;
    for (const RegressionScene &scene : scene_list())
        all.scenes.push_back(scene.name);
    for (const Technique &technique : technique_list())
        all.techniques.push_back(describe(technique));
    return all;
}

FigureTable<double> measure_figures(gpu &g, const Selection &selection, const std::string &cache_folder,
                                    Progress &progress)
{
    FigureTable<double> table;
    const std::vector<Technique> techniques = technique_list();
    Stage stage(g, techniques);
    for (const RegressionScene &entry : scene_list()) {
        if (!contains(selection.scenes, entry.name))
            continue;
        progress.show(entry.name);
        const Scene scene = make_scene(entry.scene, entry.options);
        Case data = render_case(g, scene, case_size);
        add_truth(data, scene, truth_rays, cache_folder, progress);
        stage.enter(std::move(data));
        for (size_t i = 0; i < techniques.size(); i++) {
            const std::string name = describe(techniques[i]);
            progress.fraction(static_cast<double>(i) / static_cast<double>(techniques.size()));
            if (contains(selection.techniques, name))
                table[entry.name][name] = stage.measure(i);
        }
    }
    progress.clear();
    return table;
}
