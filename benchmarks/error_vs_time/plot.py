#!/usr/bin/env python3
"""Draws error against run time from error_vs_time.csv and writes the summary: plot.py FOLDER [README]

One figure per error measure with a panel a scene: a line per knob, the Pareto hull of Drape and of Bullet's built-in
collision, zero error on a strip of its own below the axis. Capped runs stand at the top as crosses. With README, the table
between its error_vs_time markers is replaced (and appended where there are none). Needs python3-matplotlib.
"""
import math
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from results import in_order, read_json, read_rows, select

# Column, what it says, file name.
ERRORS = (
    ("penetration_max", "deepest penetration / thickness", "penetration"),
    ("penetration_p99", "penetration / thickness, 99th percentile", "penetration_p99"),
    ("intersecting_end", "intersecting pairs after the last frame", "pairs"),
    ("nodes_through", "nodes that went through the obstacle", "through"),
    ("rest_speed_mm_s", "RMS speed over the last tenth, mm/s", "rest"),
    ("energy_gain", "energy gained / energy of the fall", "energy"),
    ("shape_error", "shape against small steps / thickness", "shape"),
)
GROUPS = {"drape": ("C0", "Drape, device"), "drape_host": ("C2", "Drape, host"), "bullet": ("C3", "Bullet built in")}
MARKERS = {"defaults": "*", "reference": "D", "substeps": "o", "iterations": "s", "thickness": "^", "margin": "^",
           "activation": "v", "voxel": "P"}
BEGIN = "<!-- error_vs_time: made by plot.py -->"
END = "<!-- end of error_vs_time -->"


def is_drape(row):
    return row["method"] != "bullet"


def points_of(rows, error):
    """(ms, low, high, error) of the runs that ended and have both."""
    return [(row["frame_median_ms"], row["frame_p5_ms"], row["frame_p95_ms"], row[error])
            for row in rows if row["ended"] == "whole" and error in row and "frame_median_ms" in row]


def pareto(points):
    """Those that no other beats in both, by rising time."""
    hull, best = [], float("inf")
    for point in sorted((point[0], point[-1]) for point in points):
        if point[1] < best:
            hull.append(point)
            best = point[1]
    return hull


def draw_knob(axes, rows, method, knob, error, floor):
    points = sorted(points_of(select(rows, method=method, knob=knob) + select(rows, method=method, knob="defaults"), error)
                    if knob not in ("defaults", "reference") else points_of(select(rows, method=method, knob=knob), error))
    if not points:
        return
    x = [point[0] for point in points]
    y = [point[3] or floor for point in points]
    spread = [[point[0] - point[1] for point in points], [point[2] - point[0] for point in points]]
    colour, name = GROUPS[method]
    axes.errorbar(x, y, xerr=spread, color=colour, marker=MARKERS.get(knob, "."), markersize=9 if knob == "defaults" else 4,
                  linewidth=0.7, elinewidth=0.3, alpha=0.8, label=f"{name}: {knob}")


def draw_panel(axes, rows, error):
    values = [point[3] for point in points_of(rows, error) if point[3] > 0]
    low = min(values, default=1)
    floor = 10 ** (math.floor(math.log10(low)) - 1)
    for method in GROUPS:
        for knob in in_order(select(rows, method=method), "knob"):
            draw_knob(axes, rows, method, knob, error, floor)
    for drape, colour in ((True, "C0"), (False, "C3")):
        hull = pareto(points_of([row for row in rows if is_drape(row) == drape], error))
        if hull:
            axes.step([x for x, _ in hull], [y or floor for _, y in hull], where="post", color=colour, linewidth=2.5,
                      alpha=0.35)
    capped = [row for row in rows if row["ended"] == "capped"]
    for i, row in enumerate(capped):
        axes.plot(0.02 + 0.04 * i, 0.97, "x", color=GROUPS[row["method"]][0], transform=axes.transAxes)
    if capped:
        axes.text(0.02, 0.90, f"× {len(capped)} stalled, capped", transform=axes.transAxes, fontsize=7)
    axes.axhspan(floor / 2, floor * 2, color="0.9")
    axes.text(0.99, 0.02, "zero", transform=axes.transAxes, ha="right", fontsize=7)
    axes.set(xscale="log", yscale="log", title=rows[0]["scene"], xlabel="ms a frame of 1/60 s (5 % to 95 %)")
    axes.set_ylim(bottom=floor / 2)
    axes.yaxis.set_major_formatter(lambda value, _: "" if value < 2.5 * floor else f"{value:g}")  # the strip is zero
    axes.yaxis.set_minor_formatter(lambda value, _: "")
    axes.grid(True, which="major", alpha=0.25)


def draw(rows, folder):
    scenes = in_order(rows, "scene")
    for error, label, name in ERRORS:
        shown = [scene for scene in scenes if points_of(select(rows, scene=scene), error)]
        if not shown:
            continue
        figure, all_axes = plt.subplots(1, len(shown), figsize=(4.2 * len(shown), 4.6), squeeze=False)
        for axes, scene in zip(all_axes[0], shown):
            draw_panel(axes, select(rows, scene=scene), error)
        all_axes[0][0].set_ylabel(label)
        entries = {}
        for axes in all_axes[0]:
            entries.update(dict(zip(*reversed(axes.get_legend_handles_labels()))))
        figure.legend(entries.values(), entries.keys(), fontsize=7, ncol=6, loc="lower center")
        figure.tight_layout(rect=(0, 0.13, 1, 1))
        figure.savefig(os.path.join(folder, f"error_{name}.png"), dpi=90)
        plt.close(figure)


def figure_of(value, digits=2):
    return "–" if value is None else "0" if value == 0 else f"{value:,.{digits}f}" if value < 100 else f"{value:,.0f}"


def summary_line(row):
    cells = [row["scene"], GROUPS[row["method"]][1], f"{row['knob']} {row['value']:g}" if row["value"] else row["knob"]]
    if row["ended"] != "whole":
        return cells + [f"{row['ended']} in frame {row['frames'] + 1:.0f}"] + ["–"] * 6
    time = "–" if "frame_median_ms" not in row else \
        f"{figure_of(row['frame_median_ms'])} ({figure_of(row.get('frame_p95_ms'))})"
    return cells + [time] + [figure_of(row.get(error)) for error, _, _ in ERRORS if error != "penetration_p99"]


def summary_rows(rows):
    """Per scene: every method's defaults, and of Bullet's knobs the run with the fewest nodes through, then the shallowest."""
    for scene in in_order(rows, "scene"):
        mine = select(rows, scene=scene)
        yield from select(mine, knob="defaults")
        turned = [row for row in mine if row["method"] == "bullet" and row["knob"] != "defaults" and row["ended"] == "whole"]
        if turned:
            yield min(turned, key=lambda row: (row.get("nodes_through", 0), row.get("penetration_max", 0)))


def zero_line(rows):
    drape = [row for row in rows if is_drape(row) and row["ended"] == "whole"]
    clean = [row for row in drape if not row.get("penetration_max") and not row.get("nodes_through")
             and not row.get("intersecting_max")]
    bullet = [row for row in rows if not is_drape(row)]
    text = f"{len(clean)} of {len(drape)} runs of Drape had no penetration, no node through and no intersecting pair in any step"
    if drape and len(clean) == len(drape):
        text += f" (so that the share of runs with one is below 3/{len(drape)}, at 95 %)"
    if bullet:
        good = [row for row in bullet if row["ended"] == "whole" and not row.get("penetration_max")
                and not row.get("nodes_through") and not row.get("intersecting_max")]
        text += f"; of Bullet's, {len(good)} of {len(bullet)}"
    return text + ".\n\n"


def summary(folder, rows):
    head = ["scene", "method", "knob", "frame, ms: median (95 %)"] + \
        [label for error, label, _ in ERRORS if error != "penetration_p99"]
    lines = [summary_line(row) for row in summary_rows(rows)]
    machine = (read_json(folder, "error_vs_time") or {}).get("machine", {})
    text = f"### Error against run time: {os.path.basename(os.path.abspath(folder))}\n\n"
    text += f"{machine.get('processor', 'unknown processor')}, commit {machine.get('commit', 'unknown')}. " + zero_line(rows)
    text += "| " + " | ".join(head) + " |\n|" + "---|" * len(head) + "\n"
    return text + "".join("| " + " | ".join(line) + " |\n" for line in lines) + "\n"


def write_summary(readme, text):
    old = open(readme).read() if os.path.exists(readme) else ""
    if BEGIN not in old:
        old = old.rstrip("\n") + ("\n\n" if old else "") + BEGIN + "\n" + END + "\n"
    before, rest = old.split(BEGIN, 1)
    after = rest.split(END, 1)[1]
    with open(readme, "w") as file:
        file.write(before + BEGIN + "\n\n" + text + END + after)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    rows = read_rows(sys.argv[1], "error_vs_time")
    if not rows:
        sys.exit(f"plot.py: no rows in {sys.argv[1]}/error_vs_time.csv")
    draw(rows, sys.argv[1])
    if len(sys.argv) == 3:
        write_summary(sys.argv[2], summary(sys.argv[1], rows))


if __name__ == "__main__":
    main()
