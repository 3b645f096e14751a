// How techniques are called and coloured in plots.
#pragma once

#include <string>
#include <vector>

#include "technique.hpp"

// One look per family. Colours are those of Okabe and Ito, which people with any colour vision can tell apart, and a
// violet; the symbols say the same again.
struct Look {
    const char *title;
    const char *colour;
    int symbol;      // gnuplot's point type
    int open_symbol; // a second one of the same shape
};
const Look &look_of(const std::string &technique);

// "bitmask, micropatches, budget 16"; the setting `without` is left out.
std::string long_name(const Technique &technique, const std::string &without = "");

// A few characters to stand beside each technique's point, where the colour says the family: "p16", "8+16". Layers are
// named only where two would be called the same.
std::vector<std::string> short_names(const std::vector<const Technique *> &techniques);

// Explains the short names.
extern const char *const short_names_key;
