"""How much faster rays are at a profile's smallest weight than at its largest, by kind and bounce.

    python3 python/coherence.py out/profile-* -o coherence.svg

Prints a table for docs/coherence.md, a row for each profile, and draws two ratios for each kind of
ray: single rays over single rays, which is locality, and the best fixed mode over the best fixed
mode, which is locality times what packets add. Small dots are scenes, large ones their geometric
means. Needs numpy and matplotlib.
"""

import argparse
import pathlib
import sys

import matplotlib
import numpy
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

import lockstep

CLASSES = [("camera", 0), ("shadow", 0)] + [
    (kind, bounce) for bounce in range(1, 5) for kind in ("bounce", "shadow")
]
FEWEST_RAYS = 30_000  # below, times are mostly those of starting


def weights(profile):
    """The constant weights, as they are written, from the smallest."""
    return sorted((w for w in set(profile.renders["weight"]) if "=" not in w), key=float)


def scene_name(profile):
    scene = pathlib.PurePath(str(profile.renders["scene"][0]))
    return scene.parent.name or scene.name


def speed(profile, weight, kind, bounce, single):
    """Rays per second of single rays, or of the fastest fixed mode; NaN where rays are too few."""
    s = profile.speeds
    rows = s[(s["weight"] == weight) & (s["kind"] == kind) & (s["bounce"] == bounce)]
    rows = rows[(rows["mode"] == "single") if single else (rows["mode"] != "auto")]
    rows = rows[rows["rays"] >= FEWEST_RAYS]
    return rows["rays_per_cpu_second"].max() if len(rows) else numpy.nan


def ratio(profile, kind, bounce, single):
    """Speed at the smallest weight over that at the largest."""
    ends = weights(profile)[0], weights(profile)[-1]
    shared, own = (speed(profile, weight, kind, bounce, single) for weight in ends)
    return shared / own


def simd_gain(profile, weight, kind, bounce):
    """The fastest fixed mode over single rays."""
    return speed(profile, weight, kind, bounce, False) / speed(profile, weight, kind, bounce, True)


def paths_per_second(profile, weight):
    rows = profile.renders[profile.renders["weight"] == weight]
    return rows["paths_per_cpu_second"].max()


def table(profiles):
    """Markdown: whole renders by weight, and bounce 1 and shadow rays in parts."""
    names = weights(profiles[0])
    head = ["scene", *(f"w = {w}" for w in names), "ratio"]
    head += ["locality, bounce 1", "SIMD, bounce 1", "locality, shadow 1", "SIMD, shadow 1"]
    lines = [head, ["---"] * len(head)]
    for profile in profiles:
        speeds = [paths_per_second(profile, w) for w in names]
        line = [scene_name(profile), *(f"{v / 1e6:.2f}" for v in speeds)]
        line.append(f"{speeds[0] / speeds[-1]:.2f}")
        for kind in ("bounce", "shadow"):
            gains = [simd_gain(profile, w, kind, 1) for w in (names[0], names[-1])]
            line.append(f"{ratio(profile, kind, 1, single=True):.2f}")
            line.append(f"{gains[0]:.2f}, {gains[1]:.2f}")
        lines.append(line)
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def geometric_mean(values):
    known = numpy.array(values)[numpy.isfinite(values)]
    return numpy.exp(numpy.log(known).mean()) if len(known) else numpy.nan


def draw(profiles):
    """Returns a matplotlib Figure."""
    figure = Figure(figsize=(7.6, 3.8), layout="constrained")
    axes = figure.subplots()
    looks = (
        ("single rays: locality", True, "o", "#3f90da"),
        ("best mode: locality and SIMD", False, "s", "#bd1f01"),
    )
    for label, single, marker, colour in looks:
        values = [[ratio(p, *c, single) for p in profiles] for c in CLASSES]
        places = range(len(CLASSES))
        for place, column in zip(places, values):
            shift = -0.08 if single else 0.08
            axes.plot(
                [place + shift] * len(column), column, marker, ms=3, alpha=0.4, mew=0, color=colour
            )
        means = [geometric_mean(column) for column in values]
        axes.plot(places, means, marker=marker, ms=7, ls="none", color=colour, label=label)
    names = [kind if kind == "camera" else f"{kind}\n{bounce}" for kind, bounce in CLASSES]
    axes.set_xticks(range(len(CLASSES)), names, fontsize="small")
    axes.set_yscale("log")
    axes.yaxis.set_major_locator(FixedLocator([0.8, 1, 1.25, 1.5, 2, 2.5, 3]))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_minor_locator(NullLocator())
    names = weights(profiles[0])
    axes.set_ylabel(f"rays per second, w = {names[0]} over w = {names[-1]}")
    axes.axhline(1, color="#717581", lw=0.8)
    axes.grid(axis="y", color="#dddddd", lw=0.6)
    axes.set_axisbelow(True)
    axes.legend(frameon=False, fontsize="small")
    return figure


def main():
    parser = argparse.ArgumentParser(
        description="Speed of coherent rays over that of independent ones."
    )
    parser.add_argument("directory", nargs="+", help="the DIRs of `lockstep profile -o DIR`")
    parser.add_argument("-o", "--output", required=True, help="file to write: .pdf, .png or .svg")
    options = parser.parse_args()
    if pathlib.Path(options.output).suffix not in (".pdf", ".png", ".svg"):
        parser.error(f"{options.output}: not a .pdf, .png or .svg")
    try:
        profiles = [lockstep.load_profile(directory) for directory in options.directory]
        for profile in profiles:
            if weights(profile) != weights(profiles[0]):
                raise lockstep.LockstepError(
                    f"{profile.directory}: has other weights than the first"
                )
        print(table(profiles))
        # The same profiles give the same file.
        matplotlib.rcParams["svg.hashsalt"] = "lockstep"
        dateless = {"metadata": {"Date": None}} if options.output.endswith(".svg") else {}
        draw(profiles).savefig(options.output, **dateless)
    except (lockstep.LockstepError, OSError) as error:
        sys.exit(f"coherence.py: {error}")


if __name__ == "__main__":
    main()
