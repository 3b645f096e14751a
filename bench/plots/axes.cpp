// Axes: ranges and tics.
#include "axes.hpp"

#include <algorithm>
#include <cmath>

#include "gnuplot.hpp"

const char *const common_axes = "set border 3 lc rgb \"#444444\"\n"
                                "set tics nomirror out scale 0.6 textcolor rgb \"#222222\"\n"
                                "set grid lc rgb \"#E4E4E4\" lw 1 lt 1\n"
                                "unset key\n";

Range widened(const Range &range, double factor)
{
    Range result{range.low / factor, range.high * factor};
    const double missing = std::sqrt(10.0) / (result.high / result.low);
    if (missing > 1.0) {
        result.low /= std::sqrt(missing);
        result.high *= std::sqrt(missing);
    }
    return result;
}

std::string log_axis(char axis, const Range &range)
{
    Tics list;
    const int first = static_cast<int>(std::floor(std::log10(range.low)));
    const int last = static_cast<int>(std::ceil(std::log10(range.high)));
    const bool sparse = range.high / range.low > 2e4; // powers of ten alone, or they would touch
    for (int exponent = first; exponent <= last; exponent++)
        for (const double digit : {1.0, 2.0, 5.0}) {
            const double value = digit * std::pow(10.0, exponent);
            if (value >= range.low && value <= range.high && (digit == 1.0 || !sparse))
                list.emplace_back(format(std::fabs(exponent) < 5 ? "%.10g" : "%.0e", value), value);
        }
    return format("set logscale %c\nset %crange [%g:%g]\n", axis, axis, range.low, range.high) + tics(axis, list);
}

std::string tics(char axis, const Tics &tics)
{
    std::string text = format("set %ctics (", axis);
    for (size_t i = 0; i < tics.size(); i++)
        text += (i ? ", " : "") + quoted(tics[i].first) + format(" %g", tics[i].second);
    return text + ")\n";
}
