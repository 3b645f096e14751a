// Costs of packets on this device: time of evaluation against what was counted, equation 6 of Yang et al. 2009; and
// what the equation does to the time with one cost of projections or another. What this prints for a class of devices
// is what lib/techniques/settings.c has.
#include <array>
#include <cstdio>

#include "suite.hpp"

namespace
{

// One measured evaluation: counts and nanoseconds.
struct Sample {
    std::array<double, 3> counts; // nodes, edges, projections
    double ns;
};

// Solves the normal equations restricted to the unknowns in `used`; the others are 0.
std::array<double, 3> solve(const std::vector<Sample> &samples, unsigned used)
{
    double a[3][4] = {};
    for (const Sample &s : samples)
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++)
                a[i][j] += s.counts[i] * s.counts[j] / (s.ns * s.ns); // relative errors
            a[i][3] += s.counts[i] / s.ns;
        }
    std::array<double, 3> x{};
    for (int i = 0; i < 3; i++)
        if (!(used >> i & 1))
            for (int j = 0; j < 4; j++)
                a[i][j] = i == j ? 1.0 : 0.0;
    for (int i = 0; i < 3; i++)
        for (int k = i + 1; k < 3; k++) {
            const double f = a[i][i] != 0.0 ? a[k][i] / a[i][i] : 0.0;
            for (int j = 0; j < 4; j++)
                a[k][j] -= f * a[i][j];
        }
    for (int i = 2; i >= 0; i--) {
        double sum = a[i][3];
        for (int j = i + 1; j < 3; j++)
            sum -= a[i][j] * x[j];
        x[i] = used >> i & 1 && a[i][i] != 0.0 ? sum / a[i][i] : 0.0;
    }
    return x;
}

double squared_error(const std::vector<Sample> &samples, const std::array<double, 3> &x)
{
    double sum = 0;
    for (const Sample &s : samples) {
        const double ns = s.counts[0] * x[0] + s.counts[1] * x[1] + s.counts[2] * x[2];
        sum += (ns / s.ns - 1.0) * (ns / s.ns - 1.0);
    }
    return sum;
}

// Least squares of relative errors without negative costs: the best of all subsets that give none.
std::array<double, 3> fit(const std::vector<Sample> &samples)
{
    std::array<double, 3> best{};
    double least = squared_error(samples, best);
    for (unsigned used = 1; used < 8; used++) {
        const std::array<double, 3> x = solve(samples, used);
        const double error = squared_error(samples, x);
        if (x[0] >= 0.0 && x[1] >= 0.0 && x[2] >= 0.0 && error < least) {
            best = x;
            least = error;
        }
    }
    return best;
}

Technique in_packets(const std::string &packet)
{
    return technique_of("contour budget=32 packet=" + packet);
}

// Packets of all pixels, or of every second one, when equation 6 takes a projection to cost some share of an edge.
Technique with_costs(const std::string &sparse, const std::string &share)
{
    return technique_of("contour budget=32 packet=4x4 sparse=" + sparse + " cost=0,1," + share);
}

} // namespace

void run_tune(Bench &bench)
{
    const std::vector<std::string> packets = {"1x1", "2x2", "3x3", "4x4", "adaptive"};
    std::vector<double> lights = {0.4, 0.8, 1.6, 3.2};
    SceneCaseOptions size{640, 480, 512, 1};
    Effort effort{5, 1.0};
    if (bench.quick()) {
        lights = {0.8};
        size = {160, 120, 256, 1};
        effort = {3, 0.3};
    }
    std::vector<Technique> techniques;
    for (const std::string &packet : packets)
        techniques.push_back(in_packets(packet));
    const std::vector<std::string> shares = {"0.5", "0.2", "0"};
    for (const std::string sparse : {"off", "on"})
        for (const std::string &share : shares)
            techniques.push_back(with_costs(sparse, share));
    const std::vector<CaseSource> sources = bench.cases({"balls", "fence"});
    bench.begin_suite("tune", sources.size() * lights.size());
    std::vector<Sample> samples;
    std::map<std::map<std::string, std::string>, double> over_single; // by settings
    int measured = 0;
    for (const CaseSource &source : sources)
        for (const double light : lights) {
            if (source.kind == CaseSource::Kind::folder && light != lights.front())
                continue; // its light is what it is
            SceneOptions scene;
            scene.light_size = light;
            const auto bench_case = bench.load(source, size, 0, scene);
            char variant[64];
            std::snprintf(variant, sizeof variant, "light %g", light);
            double single = 0;
            for (const Row &row : bench.measure(*bench_case, techniques, effort, variant)) {
                const double ms = stage_ms(row, "evaluate").value_or(0.0);
                const auto &settings = row.technique.settings;
                if (settings.at("packet") == "1x1") {
                    single = ms;
                    measured++;
                }
                over_single[settings] += ms / single;
                if (settings.count("cost") == 0 && row.stats && row.stats->edges)
                    samples.push_back({{static_cast<double>(row.stats->visited), static_cast<double>(row.stats->edges),
                                        static_cast<double>(row.stats->primitives)},
                                       1e6 * ms});
            }
        }
    if (samples.size() < 3)
        return;
    const std::array<double, 3> cost = fit(samples);
    const char *const names[] = {"packet_cost_node", "packet_cost_edge", "packet_cost_projection"};
    for (int i = 0; i < 3; i++)
        bench.report().figures.push_back({names[i], "all", cost[i], "nanoseconds of the whole device"});
    for (const std::string &packet : packets)
        bench.report().figures.push_back({"time_of_packets_over_single_pixels", "all",
                                          over_single[in_packets(packet).settings] / measured,
                                          "packet=" + packet + ", mean over cases and lights"});
    for (const std::string sparse : {"off", "on"})
        for (const std::string &share : shares)
            bench.report().figures.push_back({"time_by_cost_of_projections", "all",
                                              over_single[with_costs(sparse, share).settings] / measured,
                                              share + " edges, sparse=" + sparse});
}
