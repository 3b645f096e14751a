// What every suite works with: cases, and the measuring of techniques on them, in turn and in one process.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "progress.hpp"
#include "report.hpp"
#include "scene_case.hpp"

// Where a case comes from.
struct CaseSource {
    enum class Kind { scene, model, folder };
    Kind kind = Kind::scene;
    std::string name; // of the scene, or the path
};

struct BenchOptions {
    bool quick = false;
    std::vector<CaseSource> cases;     // replace a suite's own
    std::vector<Technique> techniques; // likewise
    std::optional<SceneCaseOptions> size;
    std::string cache;  // folder for ground truth; empty: none
    std::string images; // folder for pictures; empty: none
};

// A case on the device, with what it was made from.
struct BenchCase {
    std::optional<Scene> scene;
    Case data;
    std::unique_ptr<DeviceCase> device;
};

// How much of it to measure.
struct Effort {
    uint32_t rounds = 7;  // at most so many timed runs of each technique; 0: none, counts and errors only
    double seconds = 2.0; // at most about so long for each technique, but one run
    bool build = true;    // false: the map has not changed since the first run
};

class Bench
{
  public:
    Bench(gpu &g, Report &report, Progress &progress, const BenchOptions &options);

    gpu &device()
    {
        return gpu_;
    }
    const BenchOptions &options() const
    {
        return options_;
    }
    bool quick() const
    {
        return options_.quick;
    }
    Report &report()
    {
        return report_;
    }

    // The suite that rows belong to from here on, and how many calls of measure it makes: for the time left.
    void begin_suite(const std::string &name, size_t steps);

    // --case, --scene and --model where given, else the scenes named.
    std::vector<CaseSource> cases(const std::vector<std::string> &scenes) const;
    // --technique where given, else these, each as "name key=value key=value".
    std::vector<Technique> techniques(const std::vector<std::string> &names) const;

    // Depth buffers, and truth of `rays` rays per pixel (0: none). Size and options do not apply to folders.
    std::unique_ptr<BenchCase> load(const CaseSource &source, const SceneCaseOptions &size, uint32_t rays,
                                    const SceneOptions &scene = {});
    std::unique_ptr<BenchCase> load(Scene scene, const SceneCaseOptions &size, uint32_t rays);

    // Adds a row for each technique to the report and returns them. Techniques that need the mesh are left out where
    // there is none. Pictures go to --images. Throws Interrupted.
    std::vector<Row> measure(BenchCase &bench_case, const std::vector<Technique> &techniques, const Effort &effort,
                             const std::string &variant = "");
    // One row without a case to measure: prints it and adds it to the report.
    void add(Row row);
    // Moves the time left on by one call of measure.
    void step();

  private:
    void show(double part);
    void write_pictures(const BenchCase &bench_case, const Row &row, const FloatImage &result) const;

    gpu &gpu_;
    Report &report_;
    Progress &progress_;
    const BenchOptions &options_;
    std::string suite_;
    size_t steps_ = 1, done_ = 0;
};

// "pcss taps=64" and the like.
Technique technique_of(const std::string &text);
