// Plots of what a run of the benchmark found.
#include "plots.hpp"

#include "gnuplot.hpp"
#include "pareto_plot.hpp"
#include "skip_plot.hpp"
#include "stability_plot.hpp"
#include "sweep_plot.hpp"

void write_plots(const Report &report, const std::string &folder)
{
    for (const auto &make : {pareto_plots, sweep_plots, skip_plots, stability_plots})
        for (const Plot &plot : make(report))
            draw(plot, folder);
}
