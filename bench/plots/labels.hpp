// Places short texts beside points so that neither covers the other.
#pragma once

#include <string>
#include <utility>
#include <vector>

struct Point {
    double x = 0, y = 0; // pixels, upwards
};

struct Box {
    double left = 0, bottom = 0, right = 0, top = 0;
};

struct Label {
    Label(std::string what, Point where) : text(std::move(what)), point(where)
    {
    }

    std::string text;
    Point point; // what it belongs to
    // Set by place_labels:
    bool placed = false;
    Point centre;
    bool far = false; // needs a line to its point
};

// In order: the first have the choice. `taken` are what no label may cover, beside the points of all labels; those that
// find no room within `inside` are not placed.
void place_labels(std::vector<Label> &labels, const std::vector<Box> &taken, const Box &inside, double font_size);
