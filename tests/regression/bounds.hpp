// The file of bounds: for every figure the value it had and how far from it is allowed.
#pragma once

#include "figures.hpp"

struct Bound {
    double value = 0, within = 0;
};

struct BoundsFile {
    std::string device; // that the values are from
    FigureTable<Bound> bounds;
};

// Bounds around measured values, wide enough for another device: see bounds.cpp.
FigureTable<Bound> bounds_around(const FigureTable<double> &measured);

// One line for each figure that is out of its bounds, on either side, for each that has none, and for each bound that
// nothing was measured for.
std::vector<std::string> compare(const FigureTable<Bound> &bounds, const FigureTable<double> &measured);

// Both throw Error, one line naming the file and what is wrong with it.
BoundsFile read_bounds(const std::string &path);
void write_bounds(const std::string &path, const BoundsFile &file);
