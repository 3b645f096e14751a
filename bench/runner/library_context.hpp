// The library's context on a device, and the public structures for a case's light and matrices.
#pragma once

#include <string>

#include <softshadow/softshadow.h>

#include "error.hpp"
#include "gpu.h"
#include "light.hpp"

// What is asked for exceeds a limit of the device.
struct LimitError : Error {
    using Error::Error;
};

// A context for everything the process does with the library on this device; errors go to `last_message`.
class LibraryContext
{
  public:
    explicit LibraryContext(gpu &g);
    ~LibraryContext();
    LibraryContext(const LibraryContext &) = delete;
    LibraryContext &operator=(const LibraryContext &) = delete;
    // Throws Error, or LimitError, with the last message unless `result` is success.
    void check(softsh_result result) const;

    softsh_context *context = nullptr;
    std::string last_message;
};

softsh_light to_library(const Light &light);
void to_library(const Frustum &frustum, double view[16], double projection[16]);
