// Plots are scripts for gnuplot, which draws them.
#pragma once

#include <string>

// Everything but the terminal. Sizes are pixels of the PNG and units of the SVG.
struct Plot {
    std::string name; // of the files, without extension; what is no letter, digit, '.', '_' or '-' becomes '_'
    int width = 800, height = 600;
    std::string data; // named blocks, see data_block
    std::string body; // commands; they find a font size in `small` and a size of symbols in `point`
};

// Throws Error if gnuplot or one of its terminals for SVG and PNG is missing.
void check_gnuplot();

// Writes the script into `folder` and has gnuplot draw it as SVG and PNG beside it. Throws Error.
void draw(const Plot &plot, const std::string &folder);

// "$name << END" and so on around lines.
std::string data_block(const std::string &name, const std::string &lines);
// A string in the quotes of a script.
std::string quoted(const std::string &text);
// printf into a string.
std::string format(const char *format, ...) __attribute__((format(printf, 1, 2)));
