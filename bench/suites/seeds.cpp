// The claims of the papers, held against this machine. What cannot be tried yet is listed with its reason.
#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <functional>

#include "suite.hpp"

namespace
{

std::string text(const char *format, ...) __attribute__((format(printf, 1, 2)));

std::string text(const char *format, ...)
{
    char line[512];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    return line;
}

// Rows by what was asked for.
using Rows = std::map<std::string, Row>;

Rows measure(Bench &bench, BenchCase &bench_case, const std::vector<std::string> &names, const Effort &effort,
             const std::string &variant)
{
    std::vector<Technique> techniques;
    for (const std::string &name : names)
        techniques.push_back(technique_of(name));
    const std::vector<Row> rows = bench.measure(bench_case, techniques, effort, variant);
    Rows result;
    for (const Row &row : rows) // those that the device can hold
        for (size_t i = 0; i < names.size(); i++)
            if (describe(techniques[i]) == describe(row.technique))
                result[names[i]] = row;
    return result;
}

double time(const Rows &rows, const std::string &name)
{
    return rows.at(name).times->visibility;
}

double error(const Rows &rows, const std::string &name)
{
    return rows.at(name).error->mae;
}

double primitives(const Row &row)
{
    return row.stats && row.stats->active
               ? static_cast<double>(row.stats->primitives) / static_cast<double>(row.stats->active)
               : 0.0;
}

bool near(double value, double claimed, double tolerance)
{
    return std::fabs(value / claimed - 1.0) <= tolerance;
}

void untried(Bench &bench, const char *id, const char *claim, const char *why)
{
    bench.report().claims.push_back({id, claim, "", std::nullopt, why});
}

// S1: cost of bit fields against accumulated areas.
void bitmask_cost(Bench &bench, const SceneCaseOptions &size, const Effort &effort)
{
    const auto bench_case = bench.load({CaseSource::Kind::scene, "silhouette"}, size, 0);
    const std::string common = " primitive=micropatch aggregation=nearest accel=hsm budget=16";
    const std::vector<std::string> patterns = {"8x8", "16x16", "16x16j", "32x32"};
    const double claimed[] = {1.07, 1.69, 2.07, 4.14};
    std::vector<std::string> names = {"area layers=1" + common};
    for (const std::string &pattern : patterns)
        names.push_back("bitmask layers=1 pattern=" + pattern + common);
    names.push_back("bitmask layers=2 pattern=16x16j" + common);
    const Rows rows = measure(bench, *bench_case, names, effort, "S1");
    Claim claim{
        "S1",
        "Cost over area accumulation (512x512 map, 16 x 16 budget): 8x8 1.07, 16x16 1.69, 16j 2.07, 32x32 4.14, "
        "16j with two layers 3.58",
        "", true, ""};
    double previous = 0;
    bool ordered = true;
    for (size_t i = 0; i < patterns.size(); i++) {
        const double ratio = time(rows, names[i + 1]) / time(rows, names[0]);
        claim.measured += text("%s %.2f, ", patterns[i].c_str(), ratio);
        claim.reproduced = *claim.reproduced && near(ratio, claimed[i], 0.25);
        ordered = ordered && ratio >= previous;
        previous = ratio;
    }
    const double layers = time(rows, names.back()) / time(rows, names[0]);
    claim.measured += text("16j with two layers %.2f", layers);
    claim.reproduced = *claim.reproduced && near(layers, 3.58, 0.25);
    if (!*claim.reproduced)
        claim.why = text("not all within 25 %%; the order of the patterns %s", ordered ? "is the paper's" : "differs");
    bench.report().claims.push_back(claim);
}

// S2: the same over budgets; microquads and the MSSM.
void budget_cost(Bench &bench, const SceneCaseOptions &size, const Effort &effort)
{
    const auto bench_case = bench.load({CaseSource::Kind::scene, "balls"}, size, 0);
    Claim claim{
        "S2",
        "Budgets 18, 20, 12: 16j/area 1.6 to 2.1, 32x32/area 2.7 to 3.7, microquad/micropatch 1.01 to 1.14, MSSM "
        "instead of HSM gains 1.06 to 1.88 (area) and 1.01 to 1.63 (16j)",
        "", true, ""};
    int met = 0, of = 0;
    const auto within = [&](double value, double least, double most) {
        of++;
        met += value >= 0.9 * least && value <= 1.1 * most;
        return value;
    };
    for (const int budget : bench.quick() ? std::vector<int>{18} : std::vector<int>{18, 20, 12}) {
        const std::string common = text(" layers=1 aggregation=nearest budget=%d", budget);
        const std::string area = "area primitive=micropatch accel=hsm" + common,
                          area_mssm = "area primitive=micropatch accel=mssm" + common,
                          bits = "bitmask primitive=micropatch accel=hsm" + common,
                          bits_mssm = "bitmask primitive=micropatch accel=mssm" + common,
                          fine = "bitmask primitive=micropatch pattern=32x32 accel=hsm" + common,
                          quads = "bitmask primitive=microquad-rectangle accel=hsm" + common;
        const Rows rows = measure(bench, *bench_case, {area, area_mssm, bits, bits_mssm, fine, quads}, effort, "S2");
        claim.measured +=
            text("budget %d: 16j/area %.2f, 32x32/area %.2f, microquad/micropatch %.2f, MSSM gains %.2f and "
                 "%.2f; ",
                 budget, within(time(rows, bits) / time(rows, area), 1.6, 2.1),
                 within(time(rows, fine) / time(rows, area), 2.7, 3.7),
                 within(time(rows, quads) / time(rows, bits), 1.01, 1.14),
                 within(time(rows, area) / time(rows, area_mssm), 1.06, 1.88),
                 within(time(rows, bits) / time(rows, bits_mssm), 1.01, 1.63));
    }
    claim.reproduced = met == of;
    if (met != of)
        claim.why = text("%d of %d ratios lie in the paper's ranges widened by 10 %%", met, of);
    bench.report().claims.push_back(claim);
}

// S3, S15, S16: time and memory of the hierarchies.
void build_cost(Bench &bench, const Effort &effort)
{
    const std::string hsm = "bitmask accel=hsm budget=8", ysm = "bitmask accel=ysm budget=8",
                      mssm = "bitmask accel=mssm budget=8";
    const double mssm_claims[] = {0.35, 1.15, 4.6, 6.7};
    Claim s3{"S3", "MSSM/HSM build cost 0.35, 1.15, 4.6, 6.7 at 256, 512, 1024 and 2048 texels", "", true, ""};
    Claim s15{"S15", "Memory: 1024 texels HSM 10.67, MSSM 88, YSM 14.67 MiB; 2048 texels 42.67, 384, 46.67 MiB", "",
              true, ""};
    Claim s16{"S16", "Build at 1024: YSM/HSM 1.77, MSSM/HSM 15.1; at 2048: 1.23 and 21.4", "", true, ""};
    std::string left_out;
    int i = 0;
    for (const uint32_t map : {256u, 512u, 1024u, 2048u}) {
        if (bench.quick() && map > 512)
            break;
        const auto bench_case = bench.load({CaseSource::Kind::scene, "balls"}, {160, 120, map, 1}, 0);
        const Rows rows = measure(bench, *bench_case, {hsm, ysm, mssm}, effort, text("S3, S15, S16: map %u", map));
        if (!rows.count(mssm)) {
            left_out = text("an MSSM of %u texels is more than the device can hold", map);
            break;
        }
        const auto ratio = [&](const std::string &name) {
            return rows.at(name).times->build / rows.at(hsm).times->build;
        };
        const auto mebibytes = [&](const std::string &name) {
            return static_cast<double>(rows.at(name).memory->persistent) / 1048576.0;
        };
        s3.measured += text("%u: %.2f, ", map, ratio(mssm));
        s3.reproduced = *s3.reproduced && near(ratio(mssm), mssm_claims[i++], 0.25);
        if (map < 1024)
            continue;
        s16.measured += text("%u: YSM/HSM %.2f, MSSM/HSM %.2f, ", map, ratio(ysm), ratio(mssm));
        s16.reproduced = *s16.reproduced && near(ratio(ysm), map == 1024 ? 1.77 : 1.23, 0.25) &&
                         near(ratio(mssm), map == 1024 ? 15.1 : 21.4, 0.25);
        s15.measured += text("%u: %.2f, %.2f, %.2f MiB, ", map, mebibytes(hsm), mebibytes(mssm), mebibytes(ysm));
        const double rounding = 0.005; // of the paper's figures
        s15.reproduced = *s15.reproduced && mebibytes(hsm) <= (map == 1024 ? 10.67 : 42.67) + rounding &&
                         mebibytes(mssm) <= (map == 1024 ? 88.0 : 384.0) + rounding &&
                         mebibytes(ysm) <= (map == 1024 ? 14.67 : 46.67) + rounding;
    }
    if (!*s3.reproduced)
        s3.why = "not all within 25 %";
    if (!*s16.reproduced)
        s16.why = "not all within 25 %";
    s15.why = *s15.reproduced
                  ? "at most the claimed size; fan depths of all levels and a pyramid that starts at level 1"
                  : "larger";
    if (s15.measured.empty())
        s15.reproduced = s16.reproduced = std::nullopt, s15.why = s16.why = "the quick run stops at 512 texels";
    for (Claim claim : {s3, s15, s16}) {
        claim.why += (claim.why.empty() || left_out.empty() ? "" : "; ") + left_out;
        bench.report().claims.push_back(claim);
    }
}

// S4: the order of the errors.
void quality(Bench &bench, const SceneCaseOptions &size, uint32_t rays)
{
    Claim claim{"S4",
                "error(16j) close to error(32x32) and below error(16x16); balls: area > bitmask micropatch > bitmask "
                "microquad; two layers OR-ed beat their maximum; the post filter does not raise error",
                "", true, ""};
    const auto hold = [&](bool holds, const std::string &what) {
        if (!holds) {
            claim.reproduced = false;
            claim.why += (claim.why.empty() ? "not: " : "; ") + what;
        }
    };
    for (const char *scene :
         bench.quick() ? std::vector<const char *>{"balls"} : std::vector<const char *>{"balls", "silhouette"}) {
        const auto bench_case = bench.load({CaseSource::Kind::scene, scene}, size, rays);
        const std::string area = "area layers=1 primitive=micropatch", patch = "bitmask layers=1 primitive=micropatch",
                          quad = "bitmask layers=1 primitive=microquad", coarse = quad + " pattern=16x16",
                          fine = quad + " pattern=32x32", filtered = patch + " filter=5",
                          united = "bitmask layers=2 primitive=microquad merge=union",
                          darkest = "bitmask layers=2 primitive=microquad merge=max";
        Effort counts;
        counts.rounds = 0;
        // The last four no claim is about: for the table of the report.
        const Rows rows = measure(bench, *bench_case,
                                  {area, patch, quad, coarse, fine, filtered, united, darkest, quad + " pattern=8x8",
                                   "bitmask layers=1 primitive=microquad-rectangle",
                                   "area layers=1 primitive=microquad", "area layers=2 primitive=microquad merge=max"},
                                  counts, std::string("S4: ") + scene);
        claim.measured +=
            text("%s: area %.4f, micropatch %.4f, microquad 16j %.4f, 16x16 %.4f, 32x32 %.4f, filtered %.4f, "
                 "two layers %.4f, their maximum %.4f; ",
                 scene, error(rows, area), error(rows, patch), error(rows, quad), error(rows, coarse),
                 error(rows, fine), error(rows, filtered), error(rows, united), error(rows, darkest));
        hold(error(rows, quad) < error(rows, coarse), std::string("16j below 16x16 on ") + scene);
        hold(near(error(rows, quad), error(rows, fine), 0.15), std::string("16j within 15 % of 32x32 on ") + scene);
        hold(error(rows, area) > error(rows, patch), std::string("area above bitmask on ") + scene);
        hold(error(rows, patch) > error(rows, quad), std::string("micropatch above microquad on ") + scene);
        hold(error(rows, united) < error(rows, darkest), std::string("layers OR-ed below their maximum on ") + scene);
        hold(error(rows, filtered) <= error(rows, patch) + 1e-4,
             std::string("filter does not raise error on ") + scene);
    }
    bench.report().claims.push_back(claim);
}

// S17: what a budget does to the work of a pixel.
void budget_work(Bench &bench, const SceneCaseOptions &size, const Effort &effort)
{
    const auto bench_case = bench.load({CaseSource::Kind::scene, "balls"}, size, 0);
    const std::string common = "bitmask layers=1 primitive=micropatch aggregation=nearest";
    const std::vector<std::string> names = {common, common + " budget=10", common + " budget=9", common + " budget=5"};
    const Rows rows = measure(bench, *bench_case, names, effort, "S17");
    Claim claim{
        "S17",
        "Micro-occluders per active pixel 548 to 33 (budget 5), 1372 to 158 (budget 9), 3632 to 194 (budget 10); "
        "active pixels rise as the budget falls; frame rate up 3.1 to 3.5 times",
        "", true, ""};
    uint64_t active = 0;
    for (const std::string &name : names) {
        const Row &row = rows.at(name);
        claim.measured +=
            text("%s: %.0f for each of %llu, %.1f times as fast; ",
                 row.technique.settings.count("budget") ? row.technique.settings.at("budget").c_str() : "none",
                 primitives(row), static_cast<unsigned long long>(row.stats->active),
                 time(rows, names[0]) / time(rows, name));
        claim.reproduced = *claim.reproduced && row.stats->active >= active;
        active = row.stats->active;
    }
    claim.reproduced = *claim.reproduced && primitives(rows.at(names[3])) < primitives(rows.at(names[0])) / 10.0 &&
                       time(rows, names[0]) / time(rows, names[3]) >= 3.1;
    if (!*claim.reproduced)
        claim.why =
            "expected: a tenth of the micro-occluders and 3.1 times the speed at budget 5, and more active pixels at "
            "each smaller budget";
    bench.report().claims.push_back(claim);
}

// The largest difference between pictures of two techniques.
double difference(Bench &bench, BenchCase &bench_case, const std::string &a, const std::string &b)
{
    FloatImage pictures[2];
    for (int i = 0; i < 2; i++) {
        const auto estimator = make_estimator(bench.device(), *bench_case.device, technique_of(i ? b : a), false);
        estimator->run();
        pictures[i] = estimator->visibility();
    }
    double most = 0;
    for (size_t i = 0; i < pictures[0].texels.size(); i++)
        most = std::max(most, std::fabs(static_cast<double>(pictures[0].texels[i] - pictures[1].texels[i])));
    return most;
}

double per_pixel(const Row &row, uint64_t softsh_stats::*count)
{
    return row.stats && row.stats->active
               ? static_cast<double>((*row.stats).*count) / static_cast<double>(row.stats->active)
               : 0.0;
}

// S7, S8, S10: packets of pixels and the search for contours.
void packets(Bench &bench, const SceneCaseOptions &size, const Effort &effort)
{
    const std::string common = "contour layers=1 packet=", single = common + "1x1";
    const std::vector<std::string> sizes = {"2x2", "3x3", "4x4", "adaptive"};
    Claim s7{"S7", "Packets give the contours of single pixels: the same visibility up to the order of sums", "", true,
             ""};
    Claim s8{"S8",
             "Packets are never slower, whatever the light's size, nor on fine detail (2 x 2: twice as fast); coherent "
             "packets 52, 68, 88 % at light sizes 1 : 2 : 4",
             "", true, ""};
    Claim s10{"S10", "Divergence estimate (T_d = 0.8): a misclassified packet changes time, never pixels", "", true,
              ""};
    const std::vector<std::pair<const char *, double>> scenes =
        bench.quick() ? std::vector<std::pair<const char *, double>>{{"balls", 0.8}}
                      : std::vector<std::pair<const char *, double>>{
                            {"balls", 0.8}, {"balls", 1.6}, {"balls", 3.2}, {"fence", 0.8}, {"contact", 0.8}};
    for (const auto &[name, light] : scenes) {
        SceneOptions scene;
        scene.light_size = light;
        const auto bench_case = bench.load({CaseSource::Kind::scene, name}, size, 0, scene);
        std::vector<std::string> names = {single};
        for (const std::string &packet : sizes)
            names.push_back(common + packet);
        const std::string where = text("%s, light %g", name, light);
        const Rows rows = measure(bench, *bench_case, names, effort, "S8: " + where);
        s8.measured += where + ": ";
        double most = 0, best = 0, most_of_3x3 = 0;
        for (const std::string &packet : sizes) {
            const Row &row = rows.at(common + packet);
            const double gain = *stage_ms(rows.at(single), "evaluate") / *stage_ms(row, "evaluate");
            const double apart = static_cast<double>(row.stats->incoherent + row.stats->diverged) /
                                 std::max(1.0, static_cast<double>(row.stats->packets));
            s8.measured +=
                text("%s %.2f times as fast, %.0f %% coherent, ", packet.c_str(), gain, 100.0 - 100.0 * apart);
            best = std::max(best, gain);
            double &largest = packet == "3x3" ? most_of_3x3 : most;
            largest = std::max(largest, difference(bench, *bench_case, single, common + packet));
        }
        s8.measured.replace(s8.measured.size() - 2, 2, "; ");
        s8.reproduced = *s8.reproduced && best >= 1.0;
        s7.measured += text("%s: %.1e (3x3 %.1e); ", where.c_str(), most, most_of_3x3);
        s7.reproduced = *s7.reproduced && most <= 1e-4;
        const std::string strict = common + "4x4 divergence=0.01", lax = common + "4x4 divergence=1";
        const double change = difference(bench, *bench_case, strict, lax);
        s10.measured += text("%s: T_d 0.01 to 1 changes no pixel by more than %.1e; ", where.c_str(), change);
        s10.reproduced = *s10.reproduced && change <= 1e-4;
    }
    s7.why =
        "largest difference of a pixel between 1x1 and 2x2, 4x4 and adaptive packets; 3x3 has other blocks, for which "
        "the shortcuts of classification, which are not exact, find other pixels lit";
    s8.why = "time of evaluation; reproduced if some size of packets is at least as fast as single pixels everywhere. "
             "A GPU has lanes to spare before it has work to save, the software driver has not";
    for (const Claim &claim : {s7, s8, s10})
        bench.report().claims.push_back(claim);
}

// S6 and what S8 says of the hierarchy: the walk for contours.
void walk(Bench &bench, const SceneCaseOptions &size, const Effort &effort)
{
    const std::vector<std::string> accels = {"mssm", "ysm", "hsm"};
    const std::vector<std::string> sizes =
        bench.quick() ? std::vector<std::string>{"1x1"} : std::vector<std::string>{"1x1", "4x4"};
    const auto name = [](const std::string &packet, const std::string &rest) {
        return "contour layers=1 packet=" + packet + " " + rest;
    };
    Claim s6{
        "S6", "Unpruned 8 x 8 kernel: 21 node tests with the MSSM, 21 to 57 with the HSM", "", true,
        "nodes and cells for each pixel, of strips samples and blocks; reproduced if with the MSSM unpruned kernels "
        "take fewer than with the HSM. Of kernels of 8 x 8 cells the test gpu.walk counts 21 nodes with the MSSM and "
        "21 to 73 with the HSM, most where a coarser boundary is straddled"};
    Claim s8{"S8", "The hierarchy gains a further 1.5 to 4", "", true,
             "evaluation's time and visits for each evaluated pixel with pruning over without, where kernels are not "
             "refined either; MSSM"};
    for (const double light : bench.quick() ? std::vector<double>{0.8} : std::vector<double>{0.8, 1.6, 3.2}) {
        SceneOptions scene;
        scene.light_size = light;
        const auto bench_case = bench.load({CaseSource::Kind::scene, "balls"}, size, 0, scene);
        const std::string where = text("balls, light %g", light);
        std::vector<std::string> unpruned, timed;
        for (const std::string &accel : accels)
            unpruned.push_back(name("1x1", "search=walk hierarchy=off budget=8 accel=" + accel));
        for (const std::string &packet : sizes) {
            for (const std::string &accel : accels)
                timed.push_back(name(packet, "search=walk accel=" + accel));
            timed.push_back(name(packet, "accel=mssm"));
            timed.push_back(name(packet, "search=walk hierarchy=off accel=mssm"));
        }
        Effort counts;
        counts.rounds = 0;
        const Rows whole = measure(bench, *bench_case, unpruned, counts, "S6: " + where);
        const Rows rows = measure(bench, *bench_case, timed, effort, "S6, S8: " + where);
        const auto visited = [](const Row &row) { return per_pixel(row, &softsh_stats::visited); };
        const auto pixel_time = [](const Row &row) {
            return *stage_ms(row, "evaluate") / static_cast<double>(std::max<uint64_t>(row.stats->active, 1));
        };
        s6.measured +=
            text("%s: unpruned, at most 8 x 8 samples: MSSM %.0f, YSM %.0f, HSM %.0f", where.c_str(),
                 visited(whole.at(unpruned[0])), visited(whole.at(unpruned[1])), visited(whole.at(unpruned[2])));
        s6.reproduced = *s6.reproduced && visited(whole.at(unpruned[0])) < visited(whole.at(unpruned[2]));
        s8.measured += where + ": ";
        for (size_t i = 0; i < sizes.size(); i++) {
            const Row &mssm = rows.at(timed[5 * i]), &ysm = rows.at(timed[5 * i + 1]), &hsm = rows.at(timed[5 * i + 2]),
                      &strips = rows.at(timed[5 * i + 3]), &off = rows.at(timed[5 * i + 4]);
            const double gain = pixel_time(off) / pixel_time(mssm);
            s6.measured += text("; pruned, %s: MSSM %.0f, YSM %.0f, HSM %.0f, strips %.0f", sizes[i].c_str(),
                                visited(mssm), visited(ysm), visited(hsm), visited(strips));
            s8.measured +=
                text("%s %.1f times as fast, %.1f times fewer visits, the walk's time %.2f of strips'; ",
                     sizes[i].c_str(), gain, visited(off) / visited(mssm), pixel_time(mssm) / pixel_time(strips));
            s8.reproduced = *s8.reproduced && gain >= 1.5;
        }
        s6.measured += "; ";
    }
    for (const Claim &claim : {s6, s8})
        bench.report().claims.push_back(claim);
}

// A light in six directions, each with a map of its own, with a cage around it.
std::vector<Scene> omnidirectional()
{
    std::vector<Scene> scenes;
    for (int axis = 0; axis < 3; axis++)
        for (const double sign : {-1.0, 1.0}) {
            Scene scene = make_scene("lantern");
            const glm::dvec3 centre = scene.light.centre;
            glm::dvec3 towards(0.0), up(0.0);
            towards[axis] = sign;
            up[(axis + 1) % 3] = 1.0;
            place_light(scene, centre, centre + towards, up);
            scenes.push_back(scene);
        }
    return scenes;
}

// Lights around a scene, one of them above it.
std::vector<Scene> environment(size_t count)
{
    std::vector<Scene> scenes;
    for (size_t i = 0; i < count; i++) {
        Scene scene = make_scene("balls");
        const glm::dvec3 target(0.0, 0.6, 0.0);
        const double distance = glm::length(scene.light.centre - target);
        const double around = glm::radians(360.0 * static_cast<double>(i) / (static_cast<double>(count) - 1.0));
        const double from_zenith = i + 1 == count ? 0.0 : glm::radians(35.0);
        const glm::dvec3 towards(std::sin(from_zenith) * std::cos(around), std::cos(from_zenith),
                                 std::sin(from_zenith) * std::sin(around));
        place_light(scene, target + distance * towards, target, {0.0, 0.0, 1.0});
        scenes.push_back(scene);
    }
    return scenes;
}

// S8: several maps for one picture.
void several_maps(Bench &bench, const SceneCaseOptions &size, const Effort &effort)
{
    const std::string baseline = "contour layers=1 packet=1x1 hierarchy=off";
    std::vector<std::string> names = {baseline, "contour layers=1 packet=4x4", "contour layers=1 packet=2x2",
                                      "contour layers=1 packet=4x4 search=walk"};
    const std::vector<const char *> called = {"", "4x4", "2x2", "4x4 by the walk"};
    if (bench.quick())
        names.resize(2);
    const struct {
        const char *what, *claim;
        double claimed;
        std::vector<Scene> scenes;
    } lights[] = {
        {"six maps around a light in a cage", "An omni light with an occluder close by (six maps): 20 times as fast",
         20.0, omnidirectional()},
        {"nine lights", "Nine lights with 512 x 512 maps: 10 times as fast", 10.0, environment(9)},
    };
    for (const auto &light : lights) {
        Claim claim{"S8", light.claim, "", true,
                    "sum over the maps of classification's and evaluation's time and of the samples, blocks and nodes "
                    "looked at, over those of single pixels without the hierarchy. Loading receivers, edges and lanes "
                    "that wait for others do not shrink with what is looked at"};
        std::vector<double> times(names.size()), visits(names.size());
        const size_t maps = bench.quick() ? 1 : light.scenes.size();
        for (size_t i = 0; i < maps; i++) {
            const auto bench_case = bench.load(light.scenes[i], size, 0);
            const Rows rows = measure(bench, *bench_case, names, effort, text("S8: %s, map %zu", light.what, i + 1));
            for (size_t k = 0; k < names.size(); k++) {
                times[k] += time(rows, names[k]);
                visits[k] += static_cast<double>(rows.at(names[k]).stats->visited);
            }
        }
        claim.measured = text("%s%s: ", bench.quick() ? "the first of " : "", light.what);
        for (size_t k = 1; k < names.size(); k++)
            claim.measured += text("%s%s %.1f times as fast, %.0f times fewer visits", k > 1 ? "; " : "", called[k],
                                   times[0] / times[k], visits[0] / visits[k]);
        claim.reproduced = times[0] >= light.claimed * *std::min_element(times.begin() + 1, times.end());
        bench.report().claims.push_back(claim);
    }
}

// S9: what the parts of a light look at together.
void sublights(Bench &bench, const SceneCaseOptions &size, const Effort &effort)
{
    Claim claim{"S9", "Visited texels summed over S x S sub-lights stay at the single map's count; m layers raise it",
                "", true, ""};
    const std::string one = "contour layers=1 packet=1x1", two = "contour packet=1x1";
    SceneCaseOptions parts = size;
    const auto whole = bench.load({CaseSource::Kind::scene, "balls"}, size, 0);
    const Rows rows = measure(bench, *whole, {one, two}, effort, "S9: one map, two layers");
    const double single = static_cast<double>(rows.at(one).stats->visited);
    claim.measured = text("two layers %.2f of one map's", static_cast<double>(rows.at(two).stats->visited) / single);
    for (const uint32_t grid : bench.quick() ? std::vector<uint32_t>{2} : std::vector<uint32_t>{2, 3}) {
        parts.sublights = grid;
        const auto divided = bench.load({CaseSource::Kind::scene, "balls"}, parts, 0);
        const Rows of_parts = measure(bench, *divided, {two}, effort, text("S9: %u x %u", grid, grid));
        const double ratio = static_cast<double>(of_parts.at(two).stats->visited) / single;
        claim.measured += text(", %u x %u sub-lights %.2f", grid, grid, ratio);
        claim.reproduced = *claim.reproduced && ratio <= 1.25;
    }
    if (!*claim.reproduced)
        claim.why = "what the paper counts shrinks with a part's kernel; whole blocks and rims of samples do not";
    bench.report().claims.push_back(claim);
}

} // namespace

void run_seeds(Bench &bench)
{
    SceneCaseOptions size{640, 480, 512, 2};
    Effort effort{5, 0.6};
    uint32_t rays = 256;
    if (bench.quick()) {
        size = {120, 90, 256, 2};
        effort = {3, 0.2};
        rays = 64;
    }
    SceneCaseOptions small = size;
    if (!bench.quick())
        small.width = 320, small.height = 240;

    bench.begin_suite("seeds", bench.quick() ? 13 : 40);
    bitmask_cost(bench, size, effort);
    budget_cost(bench, size, effort);
    build_cost(bench, effort);
    quality(bench, small, rays);
    untried(bench, "S5", "131 scalar instructions for a 16j update",
            "drivers do not tell how many instructions a part of a shader became");
    packets(bench, size, effort);
    walk(bench, bench.quick() ? size : SceneCaseOptions{160, 120, 512, 1}, effort);
    several_maps(bench, bench.quick() ? size : SceneCaseOptions{320, 240, 512, 1}, effort);
    sublights(bench, size, effort);
    for (const char *id : {"S11", "S12"})
        untried(bench, id, "soft shadow maps (2005)", "the technique is not implemented yet");
    untried(bench, "S13", "overlap of neighbouring micropatches", "a formula, not a measurement of this benchmark");
    untried(bench, "S14", "FP16 accumulation saturates", "areas accumulate in 32 bits here");
    budget_work(bench, small, effort);
    untried(bench, "S18", "level map smoothing and blending", "quality budgets are not implemented yet");
    untried(bench, "S19", "microrects", "not implemented yet");
    untried(bench, "S20", "multisample interpolation", "not implemented yet");
    for (const char *id : {"S21", "S22", "S23", "S24"})
        untried(bench, id, "soft shadow volumes (2003)", "the technique is not implemented yet");
}
