// Technique names and settings, as the command lines of the tools take them.
#include "technique.hpp"

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

struct Setting {
    const char *key;
    const char *about;
    bool library, peers; // where it applies
    std::function<void(Technique &, const std::string &)> apply;
};

const Values on_off = {{"on", 1}, {"off", 0}};

const std::vector<Setting> &setting_list()
{
    static const std::vector<Setting> list = {
        {"accel", "hsm | mssm | ysm", true, false,
         [](Technique &t, const std::string &v) {
             t.accel = static_cast<softsh_accel>(choose(
                 "accel", v, {{"hsm", SOFTSH_ACCEL_HSM}, {"mssm", SOFTSH_ACCEL_MSSM}, {"ysm", SOFTSH_ACCEL_YSM}}));
         }},
        {"primitive", "micropatch | micropatch-unextended | microquad | microquad-rectangle", true, false,
         [](Technique &t, const std::string &v) {
             t.library.primitive = static_cast<softsh_primitive>(
                 choose("primitive", v,
                        {{"micropatch", SOFTSH_PRIMITIVE_MICROPATCH},
                         {"micropatch-unextended", SOFTSH_PRIMITIVE_MICROPATCH_UNEXTENDED},
                         {"microquad", SOFTSH_PRIMITIVE_MICROQUAD},
                         {"microquad-rectangle", SOFTSH_PRIMITIVE_MICROQUAD_RECTANGLE}}));
         }},
        {"pattern", "8x8 | 16x16 | 16x16j | 32x32", true, false,
         [](Technique &t, const std::string &v) {
             t.library.pattern = static_cast<softsh_pattern>(choose("pattern", v,
                                                                    {{"8x8", SOFTSH_PATTERN_8X8},
                                                                     {"16x16", SOFTSH_PATTERN_16X16},
                                                                     {"16x16j", SOFTSH_PATTERN_16X16_JITTERED},
                                                                     {"32x32", SOFTSH_PATTERN_32X32}}));
         }},
        {"aggregation", "nearest | sampled: depth of coarse levels", true, false,
         [](Technique &t, const std::string &v) {
             t.library.aggregation = static_cast<softsh_aggregation>(choose(
                 "aggregation", v, {{"nearest", SOFTSH_AGGREGATION_NEAREST}, {"sampled", SOFTSH_AGGREGATION_SAMPLED}}));
         }},
        {"budget", "N | inf: at most N x N micro-occluders per pixel", true, false,
         [](Technique &t, const std::string &v) { t.library.budget = v == "inf" ? 0 : number("budget", v, 1, 4096); }},
        {"level", "N: never evaluate below this level", true, false,
         [](Technique &t, const std::string &v) { t.library.min_level = number("level", v, 0, 13); }},
        {"hierarchy", "on | off: prune kernels and classify", true, false,
         [](Technique &t, const std::string &v) { t.library.no_hierarchy = !choose("hierarchy", v, on_off); }},
        {"filter", "N: passes of the post filter", true, false,
         [](Technique &t, const std::string &v) { t.library.filter_passes = number("filter", v, 0, 16); }},
        {"merge", "union | max: of layers", true, false,
         [](Technique &t, const std::string &v) {
             t.library.merge = static_cast<softsh_merge>(
                 choose("merge", v, {{"union", SOFTSH_MERGE_UNION}, {"max", SOFTSH_MERGE_MAXIMUM}}));
         }},
        {"layers", "N: use only the first N layer maps", true, true,
         [](Technique &t, const std::string &v) { t.layers = number("layers", v, 1, SOFTSH_MAX_LAYERS); }},
        {"blockers", "N: blocker taps of pcss", false, true,
         [](Technique &t, const std::string &v) { t.peer_options.blocker_taps = number("blockers", v, 1, 1024); }},
        {"taps", "N: filter taps of pcf and pcss", false, true,
         [](Technique &t, const std::string &v) { t.peer_options.filter_taps = number("taps", v, 1, 1024); }},
    };
    return list;
}

const std::vector<std::string> technique_names = {"copy", "hard", "pcf", "pcss", "area", "bitmask", "auto"};

const Setting &find_setting(const Technique &technique, const std::string &key)
{
    std::vector<std::string> valid;
    for (const Setting &setting : setting_list()) {
        const bool applies = technique.is_peer ? setting.peers : setting.library;
        /* Automatic means no settings; which maps and structure there are is not the technique's business. */
        if (technique.automatic && key != "layers" && key != "accel" && key == setting.key)
            fail("setting %s does not apply to auto, which takes accel and layers only", key.c_str());
        if (applies && key == setting.key)
            return setting;
        if (applies)
            valid.push_back(setting.key);
    }
    fail("unknown setting \"%s\" for %s, expected one of: %s", key.c_str(), technique.name.c_str(),
         join(valid).c_str());
}

} // namespace

Technique parse_technique(const std::string &name, const std::vector<std::string> &assignments)
{
    Technique t;
    t.name = name;
    t.library.struct_size = sizeof t.library;
    t.peer = peer_find(name.c_str());
    t.is_peer = t.peer != PEER_KIND_COUNT;
    if (name == "auto")
        t.automatic = true;
    else if (name == "area")
        t.library.technique = SOFTSH_TECHNIQUE_AREA;
    else if (name == "bitmask")
        t.library.technique = SOFTSH_TECHNIQUE_BITMASK;
    else if (!t.is_peer)
        fail("unknown technique \"%s\", expected one of: %s", name.c_str(), join(technique_names).c_str());
    for (const std::string &assignment : assignments) {
        const size_t equals = assignment.find('=');
        if (equals == std::string::npos)
            fail("--set %s: expected KEY=VALUE", assignment.c_str());
        const std::string key = assignment.substr(0, equals), value = assignment.substr(equals + 1);
        find_setting(t, key).apply(t, value);
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
    std::string text = "techniques: " + join(technique_names) + "\nsettings (--set KEY=VALUE):\n";
    for (const Setting &setting : setting_list())
        text += std::string("  ") + setting.key + "=" + setting.about + (setting.library ? "" : " (peers)") + "\n";
    return text;
}
