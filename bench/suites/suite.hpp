// The suites of the benchmark: one file each, one question each.
#pragma once

#include "bench.hpp"

struct Suite {
    const char *name;
    const char *about;
    void (*run)(Bench &bench);
};

// In the order in which `all` runs them.
const std::vector<Suite> &suites();

void run_pareto(Bench &bench);
void run_light_size(Bench &bench);
void run_resolution(Bench &bench);
void run_map_size(Bench &bench);
void run_budget(Bench &bench);
void run_build(Bench &bench);
void run_skip(Bench &bench);
void run_stability(Bench &bench);
void run_tune(Bench &bench);
void run_seeds(Bench &bench);
