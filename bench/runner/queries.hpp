// Timestamps of one recording.
#pragma once

#include <vector>

#include "gpu.h"

class Queries
{
  public:
    // Throws Error.
    Queries(gpu &g, uint32_t count);
    ~Queries();
    Queries(const Queries &) = delete;
    Queries &operator=(const Queries &) = delete;

    void reset(VkCommandBuffer cmd);
    // Timestamp i, of everything recorded before. The first of a recording needs what follows held back: Mesa's
    // software driver else takes it, once the device has drawn anything, together with the next one.
    void write(VkCommandBuffer cmd, uint32_t i, bool hold_back = false);
    // Milliseconds between query i and query i + 1, for n of them from `first` on.
    std::vector<double> differences(uint32_t first, uint32_t n);

    VkQueryPool pool = VK_NULL_HANDLE;

  private:
    gpu &gpu_;
    uint32_t count_;
};
