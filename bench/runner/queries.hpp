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
    // Milliseconds between query i and query i + 1, for n of them from `first` on.
    std::vector<double> differences(uint32_t first, uint32_t n);

    VkQueryPool pool = VK_NULL_HANDLE;

  private:
    gpu &gpu_;
    uint32_t count_;
};
