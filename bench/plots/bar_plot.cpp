// Horizontal bars in groups: names of any length are readable beside them, and values at their ends.
#include "bar_plot.hpp"

#include <algorithm>

#include "axes.hpp"

Plot bar_plot(const BarChart &chart)
{
    constexpr double bar = 15.0, gap = 10.0; // pixels
    const double group = bar * static_cast<double>(chart.series.size()) + gap;
    const double above = 40.0, below = 70.0 + 18.0 * static_cast<double>(chart.series.size());
    const double inside = group * static_cast<double>(chart.groups.size());
    size_t longest = 0;
    for (const std::string &name : chart.groups)
        longest = std::max(longest, name.size());

    Plot plot;
    plot.name = chart.name;
    plot.height = static_cast<int>(above + inside + below);
    double most = chart.mark.value_or(0.0);
    std::string curves;
    for (size_t s = 0; s < chart.series.size(); s++) {
        const BarSeries &series = chart.series[s];
        std::string data;
        for (size_t g = 0; g < chart.groups.size(); g++) {
            if (!series.values[g])
                continue;
            // Bars hang from the group's top; the axis counts pixels from the bottom.
            const double top = inside - group * static_cast<double>(g) - 0.5 * gap - bar * static_cast<double>(s);
            const double value = *series.values[g];
            most = std::max(most, value);
            data += format("0 %g 0 %g %g %g \"%.3g\"\n", top - 0.5 * bar, value, top - bar + 1.0, top - 1.0, value);
        }
        if (data.empty())
            continue;
        const std::string name = format("bars%zu", s);
        plot.data += data_block(name, data);
        curves +=
            (curves.empty() ? "" : ", ") +
            format("$%s using 1:2:3:4:5:6 with boxxyerror fs solid noborder lc rgb \"%s\" title ", name.c_str(),
                   series.colour.c_str()) +
            quoted(series.title) +
            format(", $%s using 4:2:7 with labels left offset char 0.4,0 font \",\" . small notitle", name.c_str());
    }
    Tics names;
    for (size_t g = 0; g < chart.groups.size(); g++)
        names.emplace_back(chart.groups[g], inside - group * (static_cast<double>(g) + 0.5));
    plot.body = std::string(common_axes) +
                format("set lmargin at screen %g\nset rmargin at screen 0.97\nset tmargin at screen %g\nset bmargin at "
                       "screen %g\n",
                       std::min(0.45, 0.03 + 0.0096 * static_cast<double>(longest)), 1.0 - above / plot.height,
                       below / plot.height) +
                "set title " + quoted(chart.title) + "\nset xlabel " + quoted(chart.label) +
                format("\nset xrange [0:%g]\nset yrange [0:%g]\n", most > 0.0 ? 1.1 * most : 1.0, inside) +
                tics('y', names) + "unset grid\nset grid xtics lc rgb \"#E4E4E4\" lw 1 lt 1\n" +
                "set key at screen 0.5,0.01 center bottom horizontal maxrows " +
                std::to_string((chart.series.size() + 1) / 2) + " Left reverse samplen 1.5 width 1\n";
    if (chart.mark)
        plot.body += format("set arrow from %g,graph 0 to %g,graph 1 nohead dt 2 lc rgb \"#444444\" back\n",
                            *chart.mark, *chart.mark);
    plot.body += "plot " + (curves.empty() ? std::string("1/0 notitle") : curves) + "\n";
    return plot;
}
