// One technique set up for one case: runs it, times its passes, reads its picture and its counts.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "device_case.hpp"
#include "technique.hpp"

struct PassTime {
    std::string name;
    double ms;
};

// Times of one run; build and visibility are separate recordings.
struct RunTimes {
    std::vector<PassTime> build, visibility;
    double wall_ms = 0; // filled by timed_run
};

struct MemoryUse {
    VkDeviceSize persistent = 0, transient = 0; // bytes
};

class Estimator
{
  public:
    virtual ~Estimator() = default;
    // Records, submits and waits once; `build` false leaves the occluders as they are, as for an unchanged map.
    virtual RunTimes run(bool build = true) = 0;
    // The visibility of the last run.
    virtual FloatImage visibility() = 0;
    // Of the last run; false if there are none (peers, or created without).
    virtual bool stats(softsh_stats &) = 0;
    virtual MemoryUse memory() const = 0;
};

// One run with the host's clock around it.
RunTimes timed_run(Estimator &estimator, bool build = true);

// With `stats` the library counts, which costs a little: time without. Throws Error, with the library's own sentence
// where it has one.
std::unique_ptr<Estimator> make_estimator(gpu &g, DeviceCase &device_case, const Technique &technique, bool stats);
