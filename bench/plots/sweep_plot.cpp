// Figures over what a suite varies, one line per technique: panels with a common key.
#include "sweep_plot.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "names.hpp"

namespace
{

constexpr double infinite = std::numeric_limits<double>::infinity();

struct Line {
    std::string title, colour;
    int symbol = 0, dash = 1;
    std::vector<const Row *> rows;
};

struct Rect {
    double x, y, width, height; // parts of the picture, from the bottom left
};

struct Layout {
    int height;
    std::vector<Rect> panels;
    Rect key;
};

Layout layout_of(size_t panels, size_t lines)
{
    if (panels == 1)
        return {400, {{0.0, 0.0, 0.66, 0.93}}, {0.66, 0.05, 0.34, 0.88}};
    if (panels == 2) {
        const double key = std::ceil(static_cast<double>(lines) / 2.0) * 18.0 + 16.0, height = key + 350.0;
        const double part = key / height, rest = 0.95 - part;
        return {static_cast<int>(height), {{0.0, part, 0.5, rest}, {0.5, part, 0.5, rest}}, {0.0, 0.0, 1.0, part}};
    }
    return {640, {{0.0, 0.48, 0.5, 0.48}, {0.5, 0.48, 0.5, 0.48}, {0.0, 0.0, 0.5, 0.48}}, {0.5, 0.0, 0.5, 0.48}};
}

// Lines in the order of the report. Those of one family share their colour and differ in dashes and symbols.
std::vector<Line> lines_of(const Sweep &sweep, const std::vector<const Row *> &rows)
{
    std::vector<Line> lines;
    std::map<std::string, int> family;
    for (const Row *row : rows) {
        const std::string title = sweep.line ? sweep.line(*row) : long_name(row->technique, sweep.setting);
        auto line = std::find_if(lines.begin(), lines.end(), [&](const Line &l) { return l.title == title; });
        if (line == lines.end()) {
            // Lines with names of their own are of one technique: they borrow colours.
            static const char *const borrowed[] = {"embree", "pcss", "auto", "bitmask"};
            const Look &look = look_of(sweep.line ? borrowed[lines.size() % 4] : row->technique.name);
            const int earlier = family[look.title]++;
            const int symbols[] = {look.symbol, look.open_symbol, 3, 2};
            lines.push_back({title, look.colour, symbols[std::min(earlier, 3)], earlier % 4 + 1, {}});
            line = lines.end() - 1;
        }
        line->rows.push_back(row);
    }
    return lines;
}

// Places that a logarithmic axis has no room for get one beside the others: no width on the left, no limit on the
// right.
struct Places {
    Range finite;
    bool zero = false, limitless = false, logarithmic = true;

    double at(double place) const
    {
        if (!logarithmic)
            return place;
        return place <= 0.0 ? finite.low / 2.0 : std::isinf(place) ? finite.high * 1.6 : place;
    }
    bool apart(double place) const
    {
        return logarithmic && (place <= 0.0 || std::isinf(place));
    }
};

std::string panel_body(const Sweep &sweep, const SweepPanel &panel, size_t number, const std::vector<Line> &lines,
                       const Places &places, Plot &plot)
{
    Range values;
    std::string curves;
    const Range ends = {places.at(places.zero ? 0.0 : places.finite.low),
                        places.at(places.limitless ? infinite : places.finite.high)};
    for (size_t i = 0; i < lines.size(); i++) {
        std::map<double, double> points;
        std::string data;
        for (const Row *row : lines[i].rows) {
            const std::optional<double> value = panel.value(*row), place = sweep.place(*row);
            if (!value || !(panel.logarithmic ? *value > 0.0 : *value >= 0.0))
                continue;
            values.show(*value);
            if (place)
                points[*place] = *value;
            else // not varied: a level across the plot
                data += format("%g %g\n%g %g\n", ends.low, *value, ends.high, *value);
        }
        const bool level = points.empty();
        for (auto point = points.begin(); point != points.end(); ++point) {
            // Blank lines keep what stands apart from being joined to the rest.
            if (point != points.begin() && (places.apart(point->first) || places.apart(std::prev(point)->first)))
                data += "\n";
            data += format("%g %g\n", places.at(point->first), point->second);
        }
        if (data.empty())
            continue;
        const std::string name = format("panel%zu_line%zu", number, i);
        plot.data += data_block(name, data);
        curves += (curves.empty() ? "" : ", ") +
                  format("$%s using 1:2 with %s lw 1.6 dt %d lc rgb \"%s\"", name.c_str(),
                         level ? "lines" : "linespoints", lines[i].dash, lines[i].colour.c_str()) +
                  (level ? "" : format(" pt %d ps 0.8 * point", lines[i].symbol));
    }
    std::string body = std::string("set ylabel ") + quoted(panel.label) + "\n";
    if (panel.logarithmic && !values.empty())
        body += log_axis('y', widened(values, 1.3));
    else
        body += format("unset logscale y\nset yrange [0:%g]\nset ytics autofreq\n",
                       values.high > 0.0 ? 1.1 * values.high : 0.01);
    return body + "plot " + (curves.empty() ? "1/0" : curves) + "\n";
}

Plot plot_of(const Sweep &sweep, const std::string &case_name, const std::vector<const Row *> &rows)
{
    const std::vector<Line> lines = lines_of(sweep, rows);
    Places places;
    places.logarithmic = sweep.logarithmic;
    std::map<double, std::string> texts;
    for (const Row *row : rows) {
        const std::optional<double> place = sweep.place(*row);
        if (!place)
            continue;
        texts[*place] = sweep.tic(*row);
        if (!places.apart(*place))
            places.finite.show(*place);
        places.zero = places.zero || *place <= 0.0;
        places.limitless = places.limitless || std::isinf(*place);
    }
    if (places.finite.empty())
        places.finite = {1.0, 1.0};
    Tics list;
    for (const auto &[place, text] : texts)
        list.emplace_back(text, places.at(place));

    Plot plot;
    plot.name = std::string(sweep.suite) + "-" + case_name;
    const Layout layout = layout_of(sweep.panels.size(), lines.size());
    plot.height = layout.height;
    plot.body = std::string(common_axes) + "set multiplot title " +
                quoted(std::string(sweep.title) + ": " + case_name) + "\nset xlabel " + quoted(sweep.label) + "\n";
    const Range across = {places.at(places.zero ? 0.0 : places.finite.low),
                          places.at(places.limitless ? infinite : places.finite.high)};
    if (sweep.logarithmic)
        plot.body += format("set logscale x\nset xrange [%g:%g]\n", across.low / 1.25, across.high * 1.25);
    else
        plot.body += format("set xrange [%g:%g]\n", across.low - 0.02 * std::max(across.high - across.low, 1e-3),
                            across.high + 0.02 * std::max(across.high - across.low, 1e-3));
    plot.body += tics('x', list);
    if (list.size() > 7)
        plot.body += "set xtics font \",\" . small\n";
    for (size_t i = 0; i < sweep.panels.size(); i++) {
        const Rect &at = layout.panels[i];
        plot.body += format("set origin %g,%g\nset size %g,%g\n", at.x, at.y, at.width, at.height) +
                     panel_body(sweep, sweep.panels[i], i, lines, places, plot);
    }
    // The key has a place of its own: a plot whose lines lie outside.
    plot.body +=
        format("set origin %g,%g\nset size %g,%g\n", layout.key.x, layout.key.y, layout.key.width, layout.key.height) +
        "unset logscale\nunset tics\nunset border\nunset xlabel\nunset ylabel\nset lmargin 0\nset rmargin 0\nset "
        "tmargin 0\nset bmargin 0\nset key center Left reverse samplen 3" +
        (sweep.panels.size() == 2 ? " maxrows " + std::to_string((lines.size() + 1) / 2) : "") + "\nplot [0:1][0:1] ";
    for (size_t i = 0; i < lines.size(); i++)
        plot.body += (i ? ", " : "") +
                     format("2 with linespoints lw 1.6 dt %d lc rgb \"%s\" pt %d ps 0.8 * point title ", lines[i].dash,
                            lines[i].colour.c_str(), lines[i].symbol) +
                     quoted(lines[i].title);
    plot.body += "\nunset multiplot\n";
    return plot;
}

} // namespace

std::vector<Plot> sweep_plots_of(const Sweep &sweep, const Report &report)
{
    std::vector<std::pair<std::string, std::vector<const Row *>>> cases;
    for (const Row &row : report.rows) {
        if (row.suite != sweep.suite)
            continue;
        auto found = std::find_if(cases.begin(), cases.end(), [&](const auto &c) { return c.first == row.case_name; });
        if (found == cases.end())
            found = cases.insert(cases.end(), {row.case_name, {}});
        found->second.push_back(&row);
    }
    std::vector<Plot> plots;
    for (const auto &[name, rows] : cases)
        plots.push_back(plot_of(sweep, name, rows));
    return plots;
}
