"""The report's main figure with matplotlib: error against CPU time, with the spread over seeds.

    python3 python/figure.py out/compare -o figure.pdf
    python3 python/figure.py out/compare -o figure.png --metric rmse --across spp

Or from a notebook: figure.draw(lockstep.load_comparison("out/compare")). One plot for each scene
and depth: the median over seeds (line and marker), 5 to 95 % (band), single renders (dots);
colours, dashes and markers are those of the report page. Needs numpy and matplotlib (Debian:
python3-numpy, python3-matplotlib).
"""

import argparse
import math
import pathlib
import sys

import numpy
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

import lockstep

# Petroff 2021, "Accessible Color Sequences for Data Visualization".
COLOURS = "#3f90da #ffa90e #bd1f01 #94a4a2 #832db6 #a96b59 #e76300 #b9ac70 #717581 #92dadd".split()
MARKERS = "o s ^ d v P".split()
DASHES = [(0, ()), (0, (4, 1.8)), (0, (4, 1.3, 0.9, 1.3))]  # change every five samplers
HEADINGS = {  # the page's; other metrics go by their names
    "rmse": "RMSE",
    "relmse": "relMSE",
    "flip_ldr": "FLIP",
    "yee_pixels": "Yee pixels",
    "low_pass_rmse": "low-pass RMSE",
}
NOT_METRICS = set(
    "scene sampler seed spp cpu_seconds wall_seconds depth pilot_spp mean_weight lanes "
    "lanes_active nonfinite width threads cpu".split()
)
HIGHER_IS_BETTER = {"ssim"}  # ends at 1: no logarithm makes sense of it


def draw(comparison, metric="flip_ldr", across="time"):
    """Returns a matplotlib Figure: an Axes for each scene and depth, in order of measurement.

    `metric` is a column of errors.csv, `across` "time" or "spp".
    """
    metrics = [name for name in comparison.errors.dtype.names if name not in NOT_METRICS]
    if metric not in metrics:
        raise lockstep.LockstepError(f"no metric {metric!r}; there are {', '.join(metrics)}")
    experiments = comparison.experiments()
    if not experiments:
        raise lockstep.LockstepError(f"{comparison.directory}: no render is done yet")
    columns = min(3, len(experiments))
    rows = math.ceil(len(experiments) / columns)
    figure = Figure(figsize=(5.2 * columns, 4.2 * rows), layout="constrained")
    plots = list(figure.subplots(rows, columns, squeeze=False).flat)
    for axes in plots[len(experiments) :]:
        axes.remove()
    for axes, (scene, depth) in zip(plots, experiments):
        for i, sampler in enumerate(comparison.samplers()):
            _draw_sampler(axes, comparison, (scene, depth, sampler), i, metric, across)
        axes.set_title(f"{scene}, depth {depth}", fontsize="medium")
        _set_axes(axes, comparison, metric, across)
    return figure


def _draw_sampler(axes, comparison, experiment, i, metric, across):
    """Band, renders, and the line of medians of the sampler in place `i`."""
    scene, depth, sampler = experiment
    rows = comparison.rows(scene=scene, depth=depth, sampler=sampler)
    look = {"color": COLOURS[i % len(COLOURS)]}
    places, lows, medians, highs = [], [], [], []
    for spp in numpy.unique(rows["spp"]):
        rung = rows[rows["spp"] == spp]
        # As the report does: what is not finite stands nowhere, and has no median.
        known = rung[metric][numpy.isfinite(rung[metric])]
        times = comparison.cpu_seconds(scene, depth, sampler, spp)
        runs = rung["cpu_seconds"] if across == "time" else rung["spp"]
        axes.plot(runs, rung[metric], "o", ms=2.4, alpha=0.45, mew=0, zorder=2, **look)
        if len(known) < len(rung):
            continue
        places.append(numpy.median(times) if across == "time" else spp)
        low, median, high = numpy.quantile(known, [0.05, 0.5, 0.95])
        lows.append(low), medians.append(median), highs.append(high)
    axes.fill_between(places, lows, highs, alpha=0.15, lw=0, zorder=1, **look)
    axes.plot(
        places,
        medians,
        marker=MARKERS[i % len(MARKERS)],
        linestyle=DASHES[i // 5 % len(DASHES)],
        label=sampler,
        ms=5,
        lw=1.6,
        zorder=3,
        **look,
    )


def _set_axes(axes, comparison, metric, across):
    """Scales, ticks at 1, 2 and 5 times powers of ten, labels, and the legend below."""
    axes.set_xscale("log")
    axes.set_xlabel("CPU time (s)" if across == "time" else "samples per pixel")
    axes.set_ylabel(HEADINGS.get(metric, metric))
    logarithmic = metric not in HIGHER_IS_BETTER and (comparison.errors[metric] > 0).any()
    if logarithmic:
        axes.set_yscale("log")
    for axis, is_log in ((axes.xaxis, True), (axes.yaxis, logarithmic)):
        if not is_log:
            continue
        ticks = _ticks(*axis.get_view_interval())
        if axis is axes.xaxis and across == "spp":
            ticks = numpy.unique(comparison.errors["spp"])
        axis.set_major_locator(FixedLocator(ticks))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.6g}"))
        axis.set_minor_locator(NullLocator())
    axes.grid(color="#dddddd", lw=0.6, zorder=0)
    axes.set_axisbelow(True)
    axes.legend(
        loc="upper center", bbox_to_anchor=(0.5, -0.16), ncol=3, frameon=False, fontsize="small"
    )


def _ticks(low, high):
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    for steps in ((1, 2, 5), (1,)):
        ticks = [s * 10.0**p for p in powers for s in steps if low <= s * 10.0**p <= high]
        if len(ticks) <= 9:
            break
    return ticks


def main():
    parser = argparse.ArgumentParser(description="Error against CPU time, as the report shows it.")
    parser.add_argument("directory", help="the DIR of `lockstep compare -o DIR`")
    parser.add_argument("-o", "--output", required=True, help="file to write: .pdf, .png or .svg")
    parser.add_argument("--metric", default="flip_ldr", help="a column of errors.csv (flip_ldr)")
    parser.add_argument("--across", choices=("time", "spp"), default="time")
    options = parser.parse_args()
    if pathlib.Path(options.output).suffix not in (".pdf", ".png", ".svg"):
        parser.error(f"{options.output}: not a .pdf, .png or .svg")
    try:
        figure = draw(lockstep.load_comparison(options.directory), options.metric, options.across)
        figure.savefig(options.output, dpi=200)
    except (lockstep.LockstepError, OSError) as error:
        sys.exit(f"figure.py: {error}")


if __name__ == "__main__":
    main()
