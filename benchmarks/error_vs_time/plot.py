"""Draws error against run time from error_vs_time.csv and writes the summary: plot.py FOLDER [README]

One figure per error measure with a panel a scene (or a set of queries): a line per knob, the Pareto hull of Drape and of
what is beside it, zero error on a strip of its own below the axis. Capped runs stand at the top as crosses. With README,
the tables between its error_vs_time markers are made again (or appended, where there are none), of every folder beside it.
Needs python3-matplotlib.
"""
import math
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import error_summary
from error_summary import SIMULATION_ERRORS, is_drape
from results import in_order, read_rows, select

# Column, what it says, file name.
DETECTOR_ERRORS = (
    ("miss_rate", "misses / true pairs", "detector_misses"),
    ("false_per_true", "false hits / true pairs", "detector_false_hits"),
    ("time_error_p50", "error of the time of impact / step, median", "detector_time"),
    ("time_error_max", "error of the time of impact / step, largest", "detector_time_max"),
    ("distance_error_max", "error of the distance / extent, largest", "detector_distance"),
    ("normal_error_deg_p99", "error of the normal, degrees, 99 %", "detector_normal"),
)
# Column prefix and suffix of the times, and what the axis says.
TIMES = {"simulation": ("frame_", "_ms", "ms a frame of 1/60 s (5 % to 95 %)"),
         "detector": ("query_", "_us", "µs a query (5 % to 95 %)")}
GROUPS = {"drape": ("C0", "Drape, device"), "drape_host": ("C2", "Drape, host"), "bullet": ("C3", "Bullet built in"),
          "plain": ("C1", "closest points, plainly")}
MARKERS = {"defaults": "*", "reference": "D", "substeps": "o", "iterations": "s", "thickness": "^", "margin": "^",
           "activation": "v", "voxel": "P", "mode": "X", "contacts": "d", "traversal": "<", "fall": ".", "tolerance": "o",
           "time tolerance": "s", "test": "X"}
COLUMNS = 4  # panels side by side
# Not along one line: each value is a run of its own.
SCATTERED = ("fall", "traversal", "mode", "test", "rest")


def points_of(rows, error):
    """(time, low, high, error, name) of the runs that ended and have both, at equal simulated time."""
    points = []
    for row in rows:
        if (row["knob"] == "rest") != (error == "rest_speed_mm_s"):
            continue
        if row["knob"] == "reference" and error == "shape_error":
            continue  # against itself
        prefix, suffix, _ = TIMES[row["part"]]
        time = row.get(f"{prefix}median{suffix}")
        if row["ended"] == "whole" and error in row and time is not None:
            points.append((time, row[f"{prefix}p5{suffix}"], row[f"{prefix}p95{suffix}"], row[error], row.get("setting", "")))
    return points


def pareto(points):
    """Those that no other beats in both, by rising time."""
    hull, best = [], float("inf")
    for point in sorted((point[0], point[3]) for point in points):
        if point[1] < best:
            hull.append(point)
            best = point[1]
    return hull


def base_of(rows, method, knob):
    """The run in which the knob has its usual value: Bullet's are turned at a voxel of their own."""
    turned = select(rows, method=method, knob=knob)
    if method != "bullet" or knob == "voxel" or not turned:
        return select(rows, method=method, knob="defaults")
    return select(rows, method=method, knob="voxel", voxel_m=turned[0]["voxel_m"])


def draw_knob(axes, rows, method, knob, error, floor):
    points = points_of(select(rows, method=method, knob=knob), error)
    if points and knob not in SCATTERED + ("defaults", "reference"):
        points += points_of(base_of(rows, method, knob), error)
    if not points:
        return
    points.sort(key=lambda point: point[0])
    x = [point[0] for point in points]
    y = [point[3] or floor for point in points]
    spread = [[max(point[0] - point[1], 0) for point in points], [max(point[2] - point[0], 0) for point in points]]
    colour, name = GROUPS[method]
    axes.errorbar(x, y, xerr=spread, color=colour, marker=MARKERS.get(knob, "."), markersize=9 if knob == "defaults" else 5,
                  linewidth=0 if knob in SCATTERED else 0.7, elinewidth=0.3, alpha=0.8, label=f"{name}: {knob}")
    named = [point for point in points if point[4] and knob != "traversal"]
    for i, (time, _, _, value, setting) in enumerate(named):
        axes.annotate(setting, (time, value or floor), fontsize=5, xytext=(2, 3 + 5 * i), textcoords="offset points")


def mark_what_did_not_end(axes, rows):
    capped = [row for row in rows if row["ended"] == "capped"]
    for i, row in enumerate(capped):
        axes.plot(0.02 + 0.04 * i, 0.97, "x", color=GROUPS[row["method"]][0], transform=axes.transAxes)
    left = sum(row["ended"] in ("left out", "no time") for row in rows)
    said = [f"× {len(capped)} stalled, capped"] * bool(capped) + [f"{left} left out"] * bool(left)
    axes.text(0.02, 0.90, ", ".join(said), transform=axes.transAxes, fontsize=7)


def draw_panel(axes, rows, error):
    values = [point[3] for point in points_of(rows, error) if point[3] > 0]
    low = min(values, default=1)
    floor = 10 ** (math.floor(math.log10(low)) - 1)
    for method in GROUPS:
        for knob in in_order(select(rows, method=method), "knob"):
            draw_knob(axes, rows, method, knob, error, floor)
    for drape, colour in ((True, "C0"), (False, "C3")):
        # Another fall is no choice.
        hull = pareto(points_of([row for row in rows if is_drape(row) == drape and not row.get("seed")], error))
        if hull:
            axes.step([x for x, _ in hull], [y or floor for _, y in hull], where="post", color=colour, linewidth=2.5,
                      alpha=0.35)
    mark_what_did_not_end(axes, rows)
    axes.axhspan(floor / 2, floor * 2, color="0.9")
    axes.text(0.99, 0.02, "zero", transform=axes.transAxes, ha="right", fontsize=7)
    axes.set(xscale="log", yscale="log", title=rows[0]["scene"], xlabel=TIMES[rows[0]["part"]][2])
    axes.set_ylim(floor / 2, 3 * max(values, default=1))
    axes.yaxis.set_major_formatter(lambda value, _: "" if value < 2.5 * floor else f"{value:g}")  # the strip is zero
    axes.yaxis.set_minor_formatter(lambda value, _: "")
    axes.grid(True, which="major", alpha=0.25)


def draw(rows, errors, folder):
    scenes = in_order(rows, "scene")
    for error, label, name in errors:
        shown = [scene for scene in scenes if points_of(select(rows, scene=scene), error)]
        if not shown:
            continue
        columns = min(max(len(shown), 2), COLUMNS)
        lines = math.ceil(len(shown) / columns)
        figure, grid = plt.subplots(lines, columns, figsize=(4.2 * columns, 3.9 * lines + 0.8), squeeze=False)
        all_axes = list(grid.flat)
        entries = {}
        for axes, scene in zip(all_axes, shown):
            draw_panel(axes, select(rows, scene=scene), error)
            entries.update(dict(zip(*reversed(axes.get_legend_handles_labels()))))
        for axes in all_axes[len(shown):]:
            axes.set_visible(False)
        for line in grid:
            line[0].set_ylabel(label, fontsize=8)
        figure.legend(entries.values(), entries.keys(), fontsize=6.5, ncol=columns + 1, loc="lower center")
        figure.tight_layout(rect=(0, 0.8 / (3.9 * lines + 0.8), 1, 1))
        figure.savefig(os.path.join(folder, f"error_{name}.png"), dpi=90)
        plt.close(figure)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    rows = read_rows(sys.argv[1], "error_vs_time")
    if not rows:
        sys.exit(f"plot.py: no rows in {sys.argv[1]}/error_vs_time.csv")
    draw(select(rows, part="simulation"), SIMULATION_ERRORS, sys.argv[1])
    draw(select(rows, part="detector"), DETECTOR_ERRORS, sys.argv[1])
    if len(sys.argv) == 3:
        error_summary.write(sys.argv[2])


if __name__ == "__main__":
    main()
