// Places short texts beside points so that neither covers the other: greedy, each at the nearest free place of several
// rings around its point.
#include "labels.hpp"

#include <cmath>

namespace
{

bool overlap(const Box &a, const Box &b)
{
    return a.left < b.right && b.left < a.right && a.bottom < b.top && b.bottom < a.top;
}

bool within(const Box &a, const Box &b)
{
    return a.left >= b.left && a.right <= b.right && a.bottom >= b.bottom && a.top <= b.top;
}

// UTF-8 continues with bytes 10xxxxxx.
double letters(const std::string &text)
{
    double count = 0;
    for (const char c : text)
        count += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    return count;
}

bool is_free(const Box &box, const std::vector<Box> &taken)
{
    for (const Box &other : taken)
        if (overlap(box, other))
            return false;
    return true;
}

} // namespace

void place_labels(std::vector<Label> &labels, const std::vector<Box> &taken, const Box &inside, double font_size)
{
    constexpr double symbol = 5.0; // half a symbol's width
    std::vector<Box> full = taken;
    for (const Label &label : labels)
        full.push_back(
            {label.point.x - symbol, label.point.y - symbol, label.point.x + symbol, label.point.y + symbol});
    // Above and below first: time and error have bars and neighbours to the sides.
    const Point directions[] = {{0, 1},      {0, -1},      {1, 0},   {-1, 0},   {0.8, 0.8}, {0.8, -0.8},
                                {-0.8, 0.8}, {-0.8, -0.8}, {0.4, 1}, {-0.4, 1}, {0.4, -1},  {-0.4, -1}};
    for (Label &label : labels) {
        const double half_width = 0.5 * (0.62 * font_size * letters(label.text) + 2.0);
        const double half_height = 0.6 * font_size;
        for (const double gap : {symbol + 1.0, symbol + 6.0, symbol + 14.0, symbol + 24.0, symbol + 36.0}) {
            for (const Point &direction : directions) {
                const Point centre = {label.point.x + direction.x * (half_width + gap),
                                      label.point.y + direction.y * (half_height + gap)};
                const Box box = {centre.x - half_width, centre.y - half_height, centre.x + half_width,
                                 centre.y + half_height};
                if (!within(box, inside) || !is_free(box, full))
                    continue;
                label.placed = true;
                label.centre = centre;
                label.far = gap > symbol + 10.0;
                full.push_back(box);
                break;
            }
            if (label.placed)
                break;
        }
    }
}
