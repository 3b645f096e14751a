// The list of suites.
#include "suite.hpp"

const std::vector<Suite> &suites()
{
    static const std::vector<Suite> list = {
        {"pareto", "every technique and its useful settings: error against time", run_pareto},
        {"light-size", "time, primitives and error over the light's width", run_light_size},
        {"resolution", "time over the size of the picture", run_resolution},
        {"map-size", "time, memory and error over the map's size", run_map_size},
        {"budget", "time, primitives and error over the budget", run_budget},
        {"build", "time and memory of HSM, YSM and MSSM", run_build},
        {"skip", "what a scene without penumbrae costs against a copy pass", run_skip},
        {"stability", "jumps under sub-texel light motion, and acne on tilted planes", run_stability},
        {"tune", "what packets cost on this device, for softsh_packet_cost", run_tune},
        {"seeds", "what the papers claim, held against this machine", run_seeds},
    };
    return list;
}
