// How techniques are called and coloured in plots.
#include "names.hpp"

#include <algorithm>
#include <utility>

const char *const short_names_key =
    "p, q, c: micropatches, microquads, contours, with their budget   |   PCSS: blocker + filter taps"
    "   |   march, average, Embree: samples per pixel";

const Look &look_of(const std::string &technique)
{
    static const std::pair<const char *, Look> looks[] = {
        {"copy", {"copy", "#BBBBBB", 1, 2}},         {"hard", {"hard", "#777777", 5, 4}},
        {"pcf", {"PCF", "#56B4E9", 9, 8}},           {"pcss", {"PCSS", "#0072B2", 7, 6}},
        {"march", {"march", "#E69F00", 11, 10}},     {"average", {"average", "#CC79A7", 13, 12}},
        {"embree", {"Embree", "#000000", 15, 14}},   {"area", {"area", "#8B7A00", 9, 8}},
        {"bitmask", {"bitmask", "#009E73", 5, 4}},   {"auto", {"auto", "#D55E00", 13, 12}},
        {"contour", {"contour", "#7F3C8D", 11, 10}},
    };
    static const Look other = {"other", "#000000", 3, 1};
    for (const auto &[name, look] : looks)
        if (technique == name)
            return look;
    return other;
}

namespace
{

bool is_number(const std::string &text)
{
    return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

std::string setting(const Technique &technique, const char *key, const char *otherwise = "")
{
    const auto found = technique.settings.find(key);
    return found == technique.settings.end() ? otherwise : found->second;
}

std::string plural(const std::string &count, const std::string &what)
{
    return count + " " + what + (count == "1" ? "" : "s");
}

std::string in_words(const std::string &key, const std::string &value)
{
    if (key == "primitive") {
        if (value == "microquad-rectangle")
            return "rectangles";
        if (value == "micropatch-unextended")
            return "unextended micropatches";
        return value == "micropatch" ? "micropatches" : "microquads";
    }
    if (key == "accel") {
        std::string upper = value;
        std::transform(upper.begin(), upper.end(), upper.begin(), [](char c) { return c >= 'a' ? char(c - 32) : c; });
        return upper;
    }
    if (key == "budget" && value == "inf")
        return "no budget";
    if (key == "layers")
        return plural(value, "layer");
    if (key == "samples" || key == "steps")
        return value + " " + key;
    if (key == "blockers" || key == "taps")
        return value + (key == "taps" ? " taps" : " blocker taps");
    return key + " " + value;
}

std::string short_name(const Technique &technique)
{
    std::string name, rest;
    std::vector<std::string> said = {"layers"};
    if (technique.name == "pcss") {
        said.insert(said.end(), {"blockers", "taps"});
        name = technique.settings.count("blockers") || technique.settings.count("taps")
                   ? setting(technique, "blockers", "16") + "+" + setting(technique, "taps", "32")
                   : "PCSS";
    } else if (technique.name == "contour") {
        said.push_back("budget");
        const std::string budget = setting(technique, "budget", "inf");
        name = "c" + (budget == "inf" ? "\u221e" : budget);
    } else if (technique.name == "area" || technique.name == "bitmask") {
        said.insert(said.end(), {"primitive", "budget"});
        const std::string primitive = setting(technique, "primitive", "microquad");
        const std::string budget = setting(technique, "budget", "inf");
        name = primitive == "micropatch" ? "p" : primitive == "microquad" ? "q" : primitive;
        name += budget == "inf" ? "\u221e" : budget;
    } else if (technique.settings.count("samples")) {
        said.push_back("samples");
        name = setting(technique, "samples");
    } else {
        name = look_of(technique.name).title;
    }
    for (const auto &[key, value] : technique.settings)
        if (std::find(said.begin(), said.end(), key) == said.end())
            name += " " + (is_number(value) || value == "on" || value == "off" ? key + " " : "") + value;
    return name;
}

} // namespace

std::string long_name(const Technique &technique, const std::string &without)
{
    std::string name = look_of(technique.name).title;
    if (name == "other")
        name = technique.name;
    // What is computed comes before how much of it.
    for (const bool first : {true, false})
        for (const auto &[key, value] : technique.settings)
            if (key != without && (key == "primitive") == first)
                name += ", " + in_words(key, value);
    return name;
}

std::vector<std::string> short_names(const std::vector<const Technique *> &techniques)
{
    std::vector<std::string> names;
    for (const Technique *technique : techniques)
        names.push_back(short_name(*technique));
    std::vector<std::string> result = names;
    for (size_t i = 0; i < names.size(); i++)
        for (size_t j = 0; j < names.size(); j++)
            if (i != j && names[i] == names[j] && techniques[i]->name == techniques[j]->name &&
                techniques[i]->settings.count("layers"))
                result[i] = names[i] + " " + plural(techniques[i]->settings.at("layers"), "layer");
    return result;
}
