// Work on all cores.
#pragma once

#include <cstdint>
#include <functional>

// Calls work(i) once for every i below `count`, on as many threads as there are cores but no more than `count`. Whoever
// is free takes the next i. Returns when all are done; after an exception the rest is dropped and it is thrown again.
void parallel_for(uint32_t count, const std::function<void(uint32_t)> &work);
