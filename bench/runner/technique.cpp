// Technique names and settings, as the command lines of the tools take them.
#include "technique.hpp"

#include <cstdio>
#include <cstdlib>
#include <functional>

#include "error.hpp"

namespace
{

using Values = std::vector<std::pair<std::string, uint32_t>>;

std::string join(const std::vector<std::string> &names)
{
    std::string text;
    for (const std::string &name : names)
        text += (text.empty() ? "" : ", ") + name;
    return text;
}

uint32_t choose(const std::string &key, const std::string &value, const Values &values)
{
    std::vector<std::string> names;
    for (const auto &[name, number] : values) {
        if (name == value)
            return number;
        names.push_back(name);
    }
    fail("setting %s is \"%s\", expected one of: %s", key.c_str(), value.c_str(), join(names).c_str());
}

uint32_t number(const std::string &key, const std::string &value, uint32_t least, uint32_t most)
{
    char *end = nullptr;
    const unsigned long parsed = std::strtoul(value.c_str(), &end, 10);
    if (value.empty() || *end != '\0' || value[0] == '-' || parsed < least || parsed > most)
        fail("setting %s is \"%s\", expected a whole number from %u to %u", key.c_str(), value.c_str(), least, most);
    return static_cast<uint32_t>(parsed);
}

// What a setting applies to; one bit each.
enum Family : unsigned {
    ON_AREA = 1u << 0,
    ON_CONTOUR = 1u << 1,
    ON_BITMASK = 1u << 2,
    ON_AUTO = 1u << 3,
    ON_COPY = 1u << 4,
    ON_HARD = 1u << 5,
    ON_PCF = 1u << 6,
    ON_PCSS = 1u << 7,
    ON_MARCH = 1u << 8,
    ON_AVERAGE = 1u << 9,
    ON_EMBREE = 1u << 10,
    ON_LIBRARY = ON_AREA | ON_CONTOUR | ON_BITMASK,                                   // all but auto
    ON_MAPS = ON_LIBRARY | ON_AUTO | ON_COPY | ON_HARD | ON_PCF | ON_PCSS | ON_MARCH, // reads the case's maps
};

struct Name {
    const char *name;
    Family family;
    TechniqueKind kind;
    softsh_technique library;
};

const std::vector<Name> technique_list = {
    {"copy", ON_COPY, TechniqueKind::dispatch, SOFTSH_TECHNIQUE_AUTO},
    {"hard", ON_HARD, TechniqueKind::dispatch, SOFTSH_TECHNIQUE_AUTO},
    {"pcf", ON_PCF, TechniqueKind::dispatch, SOFTSH_TECHNIQUE_AUTO},
    {"pcss", ON_PCSS, TechniqueKind::dispatch, SOFTSH_TECHNIQUE_AUTO},
    {"march", ON_MARCH, TechniqueKind::dispatch, SOFTSH_TECHNIQUE_AUTO},
    {"average", ON_AVERAGE, TechniqueKind::average, SOFTSH_TECHNIQUE_AUTO},
    {"embree", ON_EMBREE, TechniqueKind::embree, SOFTSH_TECHNIQUE_AUTO},
    {"area", ON_AREA, TechniqueKind::library, SOFTSH_TECHNIQUE_AREA},
    {"contour", ON_CONTOUR, TechniqueKind::library, SOFTSH_TECHNIQUE_CONTOUR},
    {"bitmask", ON_BITMASK, TechniqueKind::library, SOFTSH_TECHNIQUE_BITMASK},
    {"auto", ON_AUTO, TechniqueKind::library, SOFTSH_TECHNIQUE_AUTO},
};

std::vector<std::string> technique_names()
{
    std::vector<std::string> names;
    for (const Name &entry : technique_list)
        names.push_back(entry.name);
    return names;
}

const Name &find_technique(const std::string &name)
{
    for (const Name &entry : technique_list)
        if (name == entry.name)
            return entry;
    fail("unknown technique \"%s\", expected one of: %s", name.c_str(), join(technique_names()).c_str());
}

struct Setting {
    const char *key;
    const char *about;
    unsigned families; // what it applies to
    std::function<void(Technique &, const std::string &)> apply;
};

const Values on_off = {{"on", 1}, {"off", 0}};

const std::vector<Setting> &setting_list()
{
    static const std::vector<Setting> list = {
        {"accel", "hsm | mssm | ysm", ON_LIBRARY | ON_AUTO,
         [](Technique &t, const std::string &v) {
             t.accel = static_cast<softsh_accel>(choose(
                 "accel", v, {{"hsm", SOFTSH_ACCEL_HSM}, {"mssm", SOFTSH_ACCEL_MSSM}, {"ysm", SOFTSH_ACCEL_YSM}}));
         }},
        {"sublights", "resident | reused: a structure for each sub-light, or one that is built again before each",
         ON_LIBRARY | ON_AUTO,
         [](Technique &t, const std::string &v) {
             t.reuse = choose("sublights", v, {{"resident", 0}, {"reused", 1}}) != 0;
         }},
        {"primitive", "micropatch | micropatch-unextended | microquad | microquad-rectangle", ON_AREA | ON_BITMASK,
         [](Technique &t, const std::string &v) {
             t.library.primitive = static_cast<softsh_primitive>(
                 choose("primitive", v,
                        {{"micropatch", SOFTSH_PRIMITIVE_MICROPATCH},
                         {"micropatch-unextended", SOFTSH_PRIMITIVE_MICROPATCH_UNEXTENDED},
                         {"microquad", SOFTSH_PRIMITIVE_MICROQUAD},
                         {"microquad-rectangle", SOFTSH_PRIMITIVE_MICROQUAD_RECTANGLE}}));
         }},
        {"pattern", "8x8 | 16x16 | 16x16j | 32x32", ON_AREA | ON_BITMASK,
         [](Technique &t, const std::string &v) {
             t.library.pattern = static_cast<softsh_pattern>(choose("pattern", v,
                                                                    {{"8x8", SOFTSH_PATTERN_8X8},
                                                                     {"16x16", SOFTSH_PATTERN_16X16},
                                                                     {"16x16j", SOFTSH_PATTERN_16X16_JITTERED},
                                                                     {"32x32", SOFTSH_PATTERN_32X32}}));
         }},
        {"aggregation", "nearest | sampled: depth of coarse levels", ON_LIBRARY,
         [](Technique &t, const std::string &v) {
             t.library.aggregation = static_cast<softsh_aggregation>(choose(
                 "aggregation", v, {{"nearest", SOFTSH_AGGREGATION_NEAREST}, {"sampled", SOFTSH_AGGREGATION_SAMPLED}}));
         }},
        {"budget", "N | inf: at most N x N micro-occluders per pixel", ON_LIBRARY,
         [](Technique &t, const std::string &v) { t.library.budget = v == "inf" ? 0 : number("budget", v, 1, 4096); }},
        {"level", "N: never evaluate below this level", ON_LIBRARY,
         [](Technique &t, const std::string &v) { t.library.min_level = number("level", v, 0, 13); }},
        {"hierarchy", "on | off: prune kernels and classify", ON_LIBRARY,
         [](Technique &t, const std::string &v) { t.library.no_hierarchy = !choose("hierarchy", v, on_off); }},
        {"refine", "on | off: finer levels than the budget's where something is thin", ON_LIBRARY,
         [](Technique &t, const std::string &v) { t.library.no_refinement = !choose("refine", v, on_off); }},
        {"outline", "on | off: microquads by the outline of those that cannot fold", ON_AREA | ON_BITMASK,
         [](Technique &t, const std::string &v) { t.library.outline = choose("outline", v, on_off); }},
        {"reconstruction", "joined | folds | second-differences: where surfaces are cut apart; or backs", ON_CONTOUR,
         [](Technique &t, const std::string &v) {
             t.library.reconstruction = static_cast<softsh_reconstruction>(
                 choose("reconstruction", v,
                        {{"joined", SOFTSH_RECONSTRUCTION_JOINED},
                         {"folds", SOFTSH_RECONSTRUCTION_FOLDS},
                         {"second-differences", SOFTSH_RECONSTRUCTION_SECOND_DIFFERENCES},
                         {"backs", SOFTSH_RECONSTRUCTION_BACKS}}));
         }},
        {"packet", "1x1 | 2x2 | 3x3 | 4x4 | adaptive: pixels that share a search for contours", ON_CONTOUR,
         [](Technique &t, const std::string &v) {
             t.library.packet = static_cast<softsh_packet>(choose("packet", v,
                                                                  {{"1x1", SOFTSH_PACKET_1X1},
                                                                   {"2x2", SOFTSH_PACKET_2X2},
                                                                   {"3x3", SOFTSH_PACKET_3X3},
                                                                   {"4x4", SOFTSH_PACKET_4X4},
                                                                   {"adaptive", SOFTSH_PACKET_ADAPTIVE}}));
         }},
        {"cost", "N,E,P: relative costs of a sample, an edge and its projection, for packets", ON_CONTOUR,
         [](Technique &t, const std::string &v) {
             softsh_packet_cost &cost = t.library.packet_cost;
             char rest = 0;
             if (std::sscanf(v.c_str(), "%f,%f,%f%c", &cost.node, &cost.edge, &cost.projection, &rest) != 3)
                 fail("setting cost is \"%s\", expected three numbers with commas", v.c_str());
         }},
        {"divergence", "P: packets likelier not to have one contour are evaluated apart; 1: none", ON_CONTOUR,
         [](Technique &t, const std::string &v) {
             char rest = 0;
             if (std::sscanf(v.c_str(), "%f%c", &t.library.packet_cost.divergence, &rest) != 1)
                 fail("setting divergence is \"%s\", expected a number", v.c_str());
         }},
        {"search", "strips | walk: for contours", ON_CONTOUR,
         [](Technique &t, const std::string &v) {
             t.library.search = static_cast<softsh_search>(
                 choose("search", v, {{"strips", SOFTSH_SEARCH_STRIPS}, {"walk", SOFTSH_SEARCH_WALK}}));
         }},
        {"sparse", "on | off: interpolate pixels between others", ON_LIBRARY,
         [](Technique &t, const std::string &v) { t.library.sparse = choose("sparse", v, on_off); }},
        {"filter", "N: passes of the post filter", ON_AREA | ON_BITMASK,
         [](Technique &t, const std::string &v) { t.library.filter_passes = number("filter", v, 0, 16); }},
        {"merge", "union | max: of layers", ON_LIBRARY,
         [](Technique &t, const std::string &v) {
             t.library.merge = static_cast<softsh_merge>(
                 choose("merge", v, {{"union", SOFTSH_MERGE_UNION}, {"max", SOFTSH_MERGE_MAXIMUM}}));
         }},
        {"layers", "N: use only the first N layer maps", ON_MAPS,
         [](Technique &t, const std::string &v) { t.layers = number("layers", v, 1, SOFTSH_MAX_LAYERS); }},
        {"blockers", "N: blocker taps", ON_PCSS,
         [](Technique &t, const std::string &v) { t.peer_options.blocker_taps = number("blockers", v, 1, 1024); }},
        {"taps", "N: filter taps", ON_PCF | ON_PCSS,
         [](Technique &t, const std::string &v) { t.peer_options.filter_taps = number("taps", v, 1, 1024); }},
        {"samples", "N: points of the light", ON_MARCH | ON_AVERAGE,
         [](Technique &t, const std::string &v) { t.peer_options.light_samples = number("samples", v, 1, 1024); }},
        {"steps", "N: most steps of a ray", ON_MARCH,
         [](Technique &t, const std::string &v) { t.peer_options.march_steps = number("steps", v, 1, 1024); }},
        {"near", "plane | fit: no blocker is nearer than the map's near plane, or than its nearest depth",
         ON_PCSS | ON_MARCH,
         [](Technique &t, const std::string &v) {
             t.fit_near = choose("near", v, {{"plane", 0}, {"fit", 1}});
         }},
        {"samples", "N: rays of a pixel, rounded down to a square number", ON_EMBREE,
         [](Technique &t, const std::string &v) { t.rays = number("samples", v, 1, 65536); }},
    };
    return list;
}

const Setting &find_setting(const Name &technique, const std::string &key)
{
    std::vector<std::string> valid;
    for (const Setting &setting : setting_list()) {
        if (!(setting.families & technique.family))
            continue;
        if (key == setting.key)
            return setting;
        valid.push_back(setting.key);
    }
    fail("unknown setting \"%s\" for %s, expected one of: %s", key.c_str(), technique.name, join(valid).c_str());
}

} // namespace

Technique parse_technique(const std::string &name, const std::vector<std::string> &assignments)
{
    Technique t;
    t.name = name;
    t.library.struct_size = sizeof t.library;
    const Name &entry = find_technique(name);
    t.kind = entry.kind;
    t.peer = peer_find(entry.name);
    t.automatic = entry.family == ON_AUTO;
    t.library.technique = entry.library;
    for (const std::string &assignment : assignments) {
        const size_t equals = assignment.find('=');
        if (equals == std::string::npos)
            fail("--set %s: expected KEY=VALUE", assignment.c_str());
        const std::string key = assignment.substr(0, equals), value = assignment.substr(equals + 1);
        find_setting(entry, key).apply(t, value);
        t.settings[key] = value;
    }
    return t;
}

std::string describe(const Technique &technique)
{
    std::string text = technique.name;
    for (const auto &[key, value] : technique.settings)
        text += " " + key + "=" + value;
    return text;
}

std::string technique_help()
{
    std::string text = "techniques: " + join(technique_names()) + "\nsettings (--set KEY=VALUE):\n";
    for (const Setting &setting : setting_list()) {
        std::vector<std::string> names;
        for (const Name &entry : technique_list)
            if (setting.families & entry.family)
                names.push_back(entry.name);
        text += std::string("  ") + setting.key + "=" + setting.about + " (" + join(names) + ")\n";
    }
    return text;
}
