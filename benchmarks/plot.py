#!/usr/bin/env python3
"""Draws the plots of measured results into their folder: plot.py FOLDER…

Reads bench_step.csv and study.csv where they are, writes PNG files beside them. Needs python3-matplotlib.
"""
import math
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import study_plots
from results import STAGES, SWEEPS, fit_exponent, in_order, read_rows, read_steps, select

# One colour and dash a method, the same in every plot; peers dashed.
STYLES = {
    "drape": ("Drape, OpenCL", "C0", "-"),
    "drape_host": ("Drape, host", "C1", "-"),
    "embree_contacts_2": ("Embree + Drape's narrow phase, 2 threads", "C2", "--"),
    "embree_contacts_1": ("the same, 1 thread", "C2", ":"),
    "embree_pairs_2": ("Embree, pairs of boxes only, 2 threads", "C3", "--"),
    "embree_pairs_1": ("the same, 1 thread", "C3", ":"),
    "fcl_pairs": ("FCL 18-DOP, pairs only", "C4", "--"),
    "fcl_collide": ("FCL 18-DOP, thickness 0", "C5", ":"),
}


def save(figure, folder, name):
    figure.tight_layout()
    figure.savefig(os.path.join(folder, name + ".png"), dpi=100)
    plt.close(figure)


def sweep_plot(rows, sweep, folder):
    size, label = SWEEPS[sweep]
    mine = select(rows, sweep=sweep, stage="step")
    if not mine:
        return
    figure, axes = plt.subplots(figsize=(9, 4.5))
    for method, (name, colour, dash) in STYLES.items():
        points = sorted((size(row), row["min_ms"], row["median_ms"], row["p95_ms"]) for row in select(mine, method=method))
        if not points:
            continue
        x, low, middle, high = zip(*points)
        axes.plot(x, middle, dash, color=colour, marker="o", markersize=3, label=name)
        axes.fill_between(x, low, high, color=colour, alpha=0.12, linewidth=0)
    axes.set(xscale="log", yscale="log", xlabel=label, ylabel="whole step, host to host, ms (median; least to p95)")
    axes.grid(True, which="both", alpha=0.25)
    study_plots.legend_beside(axes)
    save(figure, folder, "step_" + sweep)


def stages_plot(rows, sweep, folder):
    """Each stage against the size, and n log n through the largest size's sum for comparison."""
    size, label = SWEEPS[sweep]
    methods = [method for method in ("drape_kernels", "drape_host") if select(rows, sweep=sweep, method=method)]
    if not methods:
        return
    figure, all_axes = plt.subplots(1, len(methods), figsize=(6 * len(methods), 4.5), squeeze=False)
    titles = {"drape_kernels": "kernel time on the device", "drape_host": "time on the host back end"}
    for axes, method in zip(all_axes[0], methods):
        sums = {}
        for stage in STAGES:
            points = sorted((size(row), row["median_ms"]) for row in select(rows, sweep=sweep, method=method, stage=stage)
                            if "median_ms" in row)
            if not points:
                continue
            for x, y in points:
                sums[x] = sums.get(x, 0) + y
            axes.plot(*zip(*points), marker="o", markersize=3, label=f"{stage}, {slope(points)}")
        guide = [x for x in sorted(sums) if x > 1]
        if guide:
            scale = sums[guide[-1]] / (guide[-1] * math.log(guide[-1]))
            axes.plot(guide, [scale * x * math.log(x) for x in guide], ":", color="grey", label="n log n")
        axes.set(xscale="log", yscale="log", xlabel=label, ylabel="median, ms", title=titles[method])
        axes.grid(True, which="both", alpha=0.25)
        axes.legend(fontsize=7)
    save(figure, folder, "stages_" + sweep)


def slope(points):
    exponent = fit_exponent(points)
    return "" if exponent is None else f"p = {exponent:.2f}"


def shares_of(rows, method):
    """Scene, stage shares of the step's work: the host's stages, or the device's kernels by stage."""
    for scene in in_order(rows, "scene"):
        stages = {}
        for row in select(rows, scene=scene, method=method):
            if row["stage"] in STAGES and "median_ms" in row:
                stages[row["stage"]] = row["median_ms"]
        if stages:
            yield scene, stages


def share_plot(rows, folder):
    methods = [method for method in ("drape_kernels", "drape_host") if select(rows, method=method)]
    if not methods:
        return
    figure, all_axes = plt.subplots(1, len(methods), figsize=(6 * len(methods), 6), squeeze=False)
    titles = {"drape_kernels": "kernel time on the device", "drape_host": "time on the host back end"}
    for axes, method in zip(all_axes[0], methods):
        shares = list(shares_of(rows, method))
        left = [0.0] * len(shares)
        for stage in STAGES:
            parts = [stages.get(stage, 0) / sum(stages.values()) for _, stages in shares]
            if any(parts):
                axes.barh([scene for scene, _ in shares], parts, left=left, label=stage)
            left = [a + b for a, b in zip(left, parts)]
        axes.invert_yaxis()
        axes.set(xlim=(0, 1), title=titles[method], xlabel="share of the stages' sum")
        axes.tick_params(labelsize=7)
        axes.legend(fontsize=7, ncol=5, loc="lower center", bbox_to_anchor=(0.5, -0.17))
    save(figure, folder, "step_shares")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    for folder in sys.argv[1:]:
        rows = read_steps(folder)
        for sweep in SWEEPS:
            sweep_plot(rows, sweep, folder)
            stages_plot(rows, sweep, folder)
        if rows:
            share_plot(rows, folder)
        study_plots.draw(read_rows(folder, "study"), folder, save)


if __name__ == "__main__":
    main()
