// Ctrl-C during a long run: what was measured so far is kept.
#pragma once

#include <stdexcept>

// Thrown where a run can stop.
struct Interrupted : std::runtime_error {
    Interrupted() : std::runtime_error("interrupted")
    {
    }
};

// SIGINT and SIGTERM only set a flag from here on; a second one ends the process.
void catch_interrupts();
// Throws Interrupted after one.
void check_interrupted();
