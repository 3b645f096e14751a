// Error against time, all techniques of a case in one plot: who is on the front, and where PCSS lies.
#include "pareto_plot.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "axes.hpp"
#include "labels.hpp"
#include "names.hpp"

namespace
{

struct Entry {
    const Technique *technique;
    double time, low, high, error;
    bool front;
};

struct Chart {
    std::string name, title, x_label;
    std::vector<Entry> entries;
};

// Where the axes lie in the picture, as parts of it.
constexpr int width = 800, height = 640;
constexpr double left = 0.1, right = 0.975, bottom = 0.2, top = 0.93;
constexpr double label_size = 10.0;

// One chart per case and size, in the order of the report, and one of the means over cases.
std::vector<Chart> charts_of(const Report &report)
{
    std::vector<Chart> charts;
    const auto chart_of = [&](const std::string &name) -> Chart & {
        for (Chart &chart : charts)
            if (chart.name == name)
                return chart;
        charts.push_back({name, "", "", {}});
        return charts.back();
    };
    for (const Row &row : report.rows) {
        if (row.suite != "pareto")
            continue;
        const auto mean = row.measures.find("mean_error"), ratio = row.measures.find("time_over_pcss");
        if (mean != row.measures.end() && ratio != row.measures.end()) {
            Chart &chart = chart_of("pareto-all");
            chart.title = "mean of all cases";
            chart.x_label = "time over PCSS's, geometric mean";
            chart.entries.push_back(
                {&row.technique, ratio->second, ratio->second, ratio->second, mean->second, row.front.value_or(false)});
        } else if (row.times && row.error && row.technique.name != "copy") {
            const std::string size = std::to_string(row.width) + "x" + std::to_string(row.height);
            Chart &chart = chart_of("pareto-" + row.case_name + "-" + size);
            chart.title = row.case_name + ", " + size + " pixels, map " + std::to_string(row.map_size) + "\u00b2";
            chart.x_label = "time with the build, ms (median and quartiles)";
            chart.entries.push_back({&row.technique, row.times->total, row.times->total_low, row.times->total_high,
                                     row.error->mae, row.front.value_or(false)});
        }
    }
    for (Chart &chart : charts) {
        auto &entries = chart.entries;
        entries.erase(std::remove_if(entries.begin(), entries.end(),
                                     [](const Entry &e) { return !(e.low > 0.0 && e.error > 0.0); }),
                      entries.end());
    }
    charts.erase(std::remove_if(charts.begin(), charts.end(), [](const Chart &c) { return c.entries.empty(); }),
                 charts.end());
    return charts;
}

// A place in pixels for values on logarithmic axes.
struct Frame {
    Range x, y;

    Point at(double time, double error) const
    {
        const auto part = [](double value, const Range &range) {
            return std::log(value / range.low) / std::log(range.high / range.low);
        };
        return {width * (left + (right - left) * part(time, x)), height * (bottom + (top - bottom) * part(error, y))};
    }
};

// The points everything else is held against: PCSS with its own taps, and the same with near planes fitted.
bool is_pcss(const Technique &technique)
{
    const auto &settings = technique.settings;
    return technique.name == "pcss" && (settings.empty() || (settings.size() == 1 && settings.count("near")));
}

// PCSS first, then the front, then from the most accurate: labels that find no room are those nobody looks for.
std::string labels_of(const Chart &chart, const Frame &frame)
{
    std::vector<const Entry *> order;
    for (const Entry &entry : chart.entries)
        order.push_back(&entry);
    const auto rank = [](const Entry *e) { return is_pcss(*e->technique) ? 0 : e->front ? 1 : 2; };
    std::stable_sort(order.begin(), order.end(), [&](const Entry *a, const Entry *b) {
        return rank(a) != rank(b) ? rank(a) < rank(b) : a->error < b->error;
    });
    std::vector<const Technique *> techniques;
    std::vector<Label> labels;
    std::vector<Box> bars;
    for (const Entry *entry : order) {
        techniques.push_back(entry->technique);
        const Point low = frame.at(entry->low, entry->error), high = frame.at(entry->high, entry->error);
        bars.push_back({low.x, low.y - 1.0, high.x, low.y + 1.0});
        if (is_pcss(*entry->technique)) { // its guide lines
            const Point at = frame.at(entry->time, entry->error);
            bars.push_back({0.0, at.y - 1.0, width, at.y + 1.0});
            bars.push_back({at.x - 1.0, 0.0, at.x + 1.0, height});
        }
    }
    const std::vector<std::string> names = short_names(techniques);
    for (size_t i = 0; i < order.size(); i++)
        labels.emplace_back(names[i], frame.at(order[i]->time, order[i]->error));
    const Box inside = {width * left + 2, height * bottom + 2, width * right, height * top};
    place_labels(labels, bars, inside, label_size);

    std::string text;
    for (size_t i = 0; i < labels.size(); i++) {
        const Label &label = labels[i];
        if (!label.placed)
            continue;
        const char *colour = look_of(order[i]->technique->name).colour;
        if (label.far)
            text +=
                format("set arrow from screen %.4f,%.4f to screen %.4f,%.4f nohead lw 0.5 lc rgb \"#999999\"\n",
                       label.point.x / width, label.point.y / height, label.centre.x / width, label.centre.y / height);
        text += "set label " + quoted(label.text) +
                format(" at screen %.4f,%.4f center font \",\" . small textcolor rgb \"%s\" front\n",
                       label.centre.x / width, label.centre.y / height, colour);
    }
    return text;
}

Plot plot_of(const Chart &chart)
{
    Range x, y;
    for (const Entry &entry : chart.entries) {
        x.show(entry.low);
        x.show(entry.high);
        y.show(entry.error);
    }
    const Frame frame = {widened(x, 1.25), widened(y, 1.25)};

    Plot plot;
    plot.name = chart.name;
    plot.width = width;
    plot.height = height;
    std::vector<const Entry *> front;
    std::vector<std::string> families;
    std::map<std::string, std::string> points;
    for (const Entry &entry : chart.entries) {
        const std::string &family = entry.technique->name;
        if (std::find(families.begin(), families.end(), family) == families.end())
            families.push_back(family);
        points[family] += format("%g %g %g %g\n", entry.time, entry.error, entry.low, entry.high);
        if (entry.front)
            front.push_back(&entry);
    }
    std::sort(front.begin(), front.end(), [](const Entry *a, const Entry *b) { return a->time < b->time; });
    std::string line;
    for (const Entry *entry : front)
        line += format("%g %g\n", entry->time, entry->error);
    plot.data = data_block("front", line);
    for (const std::string &family : families)
        plot.data += data_block(family, points[family]);

    plot.body =
        std::string(common_axes) +
        format("set lmargin at screen %g\nset rmargin at screen %g\nset bmargin at screen %g\nset tmargin at "
               "screen %g\n",
               left, right, bottom, top) +
        "set title " + quoted(chart.title) + "\nset xlabel " + quoted(chart.x_label) +
        "\nset ylabel \"error (mean absolute difference of visibility)\"\n" + log_axis('x', frame.x) +
        log_axis('y', frame.y) +
        "set key at screen 0.5,0.045 center bottom horizontal maxrows 2 Left reverse samplen 1.5 font \",\" . small\n" +
        "set label " + quoted(short_names_key) +
        " at screen 0.5,0.022 center font \",\" . small textcolor rgb \"#555555\"\n";
    for (const Entry &entry : chart.entries) {
        if (!is_pcss(*entry.technique))
            continue;
        const char *style = "nohead dt 2 lw 1 lc rgb \"#0072B2\" back";
        plot.body +=
            format("set arrow from %g,graph 0 to %g,graph 1 %s\n", entry.time, entry.time, style) +
            format("set arrow from graph 0,first %g to graph 1,first %g %s\n", entry.error, entry.error, style);
    }
    plot.body += labels_of(chart, frame);
    plot.body += "plot ";
    if (!front.empty())
        plot.body += "$front using 1:2 with lines lw 3 lc rgb \"#CCCCCC\" title \"Pareto front\", ";
    for (size_t i = 0; i < families.size(); i++) {
        const Look &look = look_of(families[i]);
        const std::string title = std::string(look.title) == "other" ? families[i] : look.title;
        plot.body += (i ? ", " : "") +
                     format("$%s using 1:2:3:4 with xerrorbars pt %d ps point lw 1 lc rgb \"%s\" title ",
                            families[i].c_str(), look.symbol, look.colour) +
                     quoted(title);
    }
    plot.body += "\n";
    return plot;
}

} // namespace

std::vector<Plot> pareto_plots(const Report &report)
{
    std::vector<Plot> plots;
    for (const Chart &chart : charts_of(report))
        plots.push_back(plot_of(chart));
    return plots;
}
