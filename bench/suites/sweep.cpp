// How a figure grows along a sweep.
#include "sweep.hpp"

#include <cmath>

std::optional<double> growth_exponent(const std::vector<std::pair<double, double>> &points)
{
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const auto &[at, value] : points) {
        if (!(at > 0.0 && value > 0.0))
            continue;
        const double lx = std::log(at), ly = std::log(value);
        n += 1, x += lx, y += ly, xx += lx * lx, xy += lx * ly;
    }
    const double spread = n * xx - x * x;
    if (n < 2 || !(spread > 1e-12))
        return std::nullopt;
    return (n * xy - x * y) / spread;
}
