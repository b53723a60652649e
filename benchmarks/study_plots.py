"""Plots of study.csv: the thesis's figures, each with what is measured today."""
import matplotlib.pyplot as plt

from results import in_order, select
from study_tables import FRONTS


# A colour for each line of a kind, more than a kind has.
COLOURS = plt.get_cmap("tab10").colors + plt.get_cmap("Dark2").colors
DASHES = {"opencl": "-", "host": ":", "peer": "--"}


def line_styles(keys):
    """Of (backend, label) pairs: devices are solid, the host dotted, peers dashed, each kind with all colours."""
    used, styles = {}, {}
    for backend, label in keys:
        kind = backend if backend in DASHES else "peer"
        styles[label] = {"linestyle": DASHES[kind], "color": COLOURS[used.setdefault(kind, 0) % len(COLOURS)]}
        used[kind] += 1
    return styles


def legend_beside(axes):
    """For lines that leave no corner free."""
    axes.legend(fontsize=7, loc="upper left", bbox_to_anchor=(1.01, 1), borderaxespad=0)


def descent(rows, scene, folder, save):
    """Figures 4.6 and 4.8 (traversal) over a cloth's descent, and its narrow phase."""
    mine = select(rows, part="traversal", model=scene)
    if not mine:
        return
    variants = in_order(mine, "variant")
    styles = line_styles([("host" if variant.startswith("host") else "opencl", variant) for variant in variants])
    figure, (narrow, by_overlaps, by_step) = plt.subplots(1, 3, figsize=(17, 4.5))
    for variant in variants:
        steps = sorted(select(mine, variant=variant), key=lambda row: row["step"])
        # The first step of a pass follows the last: no step of the descent.
        steps = [row for row in steps if row["step"] > 0 and "broad_ms" in row]
        overlaps = sorted((row["candidates"], row["broad_ms"]) for row in steps)
        if variant != "default":  # which finds pairs of features
            by_overlaps.plot(*zip(*overlaps), marker=".", markersize=4, linewidth=0.8, label=variant, **styles[variant])
        by_step.plot([row["step"] for row in steps], [row["broad_ms"] for row in steps], label=variant, **styles[variant])
        pairs = sorted((row["candidates"], row["narrow_ms"]) for row in steps if row["candidates"] > 0)
        if pairs and variant in ("host, thesis: front", "default"):
            narrow.plot(*zip(*pairs), ".-", markersize=4, linewidth=0.8, label=variant)
    by_overlaps.set(xlabel="overlaps found, pairs of triangles", ylabel="broad phase, ms", yscale="log",
                    title="traversal against overlaps (figure 4.6)")
    by_step.set(xlabel="step of the descent", ylabel="broad phase, ms", yscale="log",
                title="traversals over a simulation (figure 4.8)")
    narrow.set(xlabel="pairs tested", ylabel="narrow phase, ms", xscale="log", yscale="log",
               title="narrow phase against pairs")
    for axes in (by_overlaps, by_step, narrow):
        axes.grid(True, alpha=0.25)
    legend_beside(by_step)  # of both
    narrow.legend(fontsize=7)
    save(figure, folder, "study_descent_" + scene)


def triangle_tests(rows, folder, save):
    """Figure 4.9: tests of triangle pairs against their number."""
    mine = [row for row in select(rows, part="triangle_tests") if time_of(row) is not None]
    if not mine:
        return
    figure, axes = plt.subplots(figsize=(7, 4.5))
    for backend in in_order(mine, "backend"):
        for variant in in_order(mine, "variant"):
            points = sorted((row["pairs"], time_of(row)) for row in select(mine, backend=backend, variant=variant))
            label = variant + (", host, 1 thread" if backend == "host" else "")
            axes.plot(*zip(*points), "-" if backend == "opencl" else "--", marker=".", label=label)
    axes.set(xscale="log", yscale="log", xlabel="pairs of triangles", ylabel="ms (kernel time; wall time of the host)",
             title="tests of triangle pairs (figure 4.9)")
    axes.grid(True, which="both", alpha=0.25)
    axes.legend(fontsize=8)
    save(figure, folder, "study_triangle_tests")


def levels(rows, folder, save):
    """Figures 4.2 to 4.4: construction by level and optimisation; 4.10: refit by level. Of the largest model, as there."""
    measured = select(rows, part="levels") + select(rows, part="refit_levels")
    if not measured:
        return
    model = max(measured, key=lambda row: row["triangles"])["model"]
    build = select(measured, part="levels", model=model)
    refit = select(measured, part="refit_levels", model=model)
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 4.5))
    for variant in in_order(build, "variant"):
        points = sorted((row["level"], row["kernel_median_ms"]) for row in select(build, variant=variant))
        left.plot(*zip(*points), ".-", markersize=4, linewidth=0.9, label=variant)
    left.set(xlabel="level, root 0", ylabel="kernel time, ms", yscale="log",
             title=f"top-down construction by level, {model} (figures 4.2–4.4)")
    small = [row for row in select(build, variant="thesis: and small splits") if row.get("small_nodes") is not None]
    if small:
        shares = left.twinx()
        points = sorted((row["level"], 100 * row["small_nodes"] / row["nodes"]) for row in small)
        shares.plot(*zip(*points), ":", color="grey", linewidth=0.9)
        shares.set(ylim=(0, 105), ylabel="% of the level's nodes that are small (dotted)")
    for variant in in_order(refit, "variant"):
        points = sorted((row["level"], row["kernel_median_ms"]) for row in select(refit, variant=variant))
        right.plot(*zip(*points), ".-", markersize=4, linewidth=0.9, label=variant)
    right.set(xlabel="height, leaves 0", ylabel="kernel time, ms", yscale="log",
              title=f"refit by height, {model} (figure 4.10)")
    for axes in (left, right):
        axes.grid(True, alpha=0.25)
        if axes.lines:
            axes.legend(fontsize=7)
    save(figure, folder, "study_levels")


def time_of(row):
    """Kernel time on a device; wall time of the host and the peers."""
    return row.get("kernel_median_ms", row.get("median_ms"))


def by_model(rows, part, title, folder, save):
    mine = [row for row in select(rows, part=part) if time_of(row) is not None]
    if not mine:
        return
    figure, axes = plt.subplots(figsize=(8, 5))
    lines = {}
    for variant in in_order(mine, "variant"):
        for threads in in_order(select(mine, variant=variant), "threads"):
            lines[variant + (f", {threads:.0f} thread(s)" if threads else "")] = select(mine, variant=variant, threads=threads)
    styles = line_styles([(chosen[0]["backend"], label) for label, chosen in lines.items()])
    for label, chosen in lines.items():
        points = sorted((row["triangles"], time_of(row)) for row in chosen)
        axes.plot(*zip(*points), marker=".", markersize=5, linewidth=0.9, label=label, **styles[label])
    axes.set(xscale="log", yscale="log", xlabel="triangles", ylabel="ms (kernel time; wall time on CPU threads)",
             title=title)
    axes.grid(True, which="both", alpha=0.25)
    legend_beside(axes)
    save(figure, folder, "study_" + part)


def grid(count, width=3):
    """Axes for so many plots, in rows; the rest is switched off."""
    lines = (count + width - 1) // width
    figure, axes = plt.subplots(lines, min(count, width), figsize=(5 * min(count, width), 4 * lines), squeeze=False)
    flat = list(axes.flat)
    for unused in flat[count:]:
        unused.axis("off")
    return figure, flat


def quality(rows, folder, save):
    """Nodes a query meets against the time to build: to the left and below is better."""
    mine = [row for row in select(rows, part="quality") if time_of(row) is not None]
    models = in_order(mine, "model")
    if not models:
        return
    figure, all_axes = grid(len(models))
    for model, axes in zip(models, all_axes):
        for row in select(mine, model=model):
            axes.plot(time_of(row), row["visits"], "o")
            axes.annotate(row["variant"], (time_of(row), row["visits"]), fontsize=7, xytext=(4, 3),
                          textcoords="offset points")
        axes.set(xscale="log", xlabel="construction, ms", ylabel="volume tests of a step",
                 title=f"quality against build time, {model}")
        axes.grid(True, alpha=0.25)
    save(figure, folder, "study_quality")


def compaction(rows, folder, save):
    """Figure 4.5: the compaction's share of the construction."""
    mine = select(rows, part="compaction")
    if not mine:
        return
    figure, axes = plt.subplots(figsize=(6, 4))
    axes.plot([row["triangles"] for row in mine], [100 * row["share"] for row in mine], "o-")
    for row in mine:
        axes.annotate(row["model"], (row["triangles"], 100 * row["share"]), fontsize=7, xytext=(4, 3),
                      textcoords="offset points")
    axes.set(xscale="log", ylim=(0, None), xlabel="triangles", ylabel="% of the kernels' time",
             title="compaction in the thesis's construction (figure 4.5)")
    axes.grid(True, alpha=0.25)
    save(figure, folder, "study_compaction")


DEGREE_PANELS = (("build_", "construction, ms"), ("refit_", "refit, ms"), ("walk_", "traversal, ms"),
                 ("visits", "volume tests"), ("candidates", "candidates"), ("bytes", "bytes of the tree"))


def degree(rows, folder, save):
    """What sides of the volumes cost and gain, against 18 of them; on the device where there is one."""
    mine = [row for row in select(rows, part="degree") if "walk_median_ms" in row]
    backend = "opencl" if select(mine, backend="opencl") else "host"
    mine = select(mine, backend=backend)
    if len({row["dop"] for row in mine}) < 2:
        return
    figure, all_axes = grid(len(DEGREE_PANELS))
    for (column, title), axes in zip(DEGREE_PANELS, all_axes):
        for model in in_order(mine, "model"):
            values = {row["dop"]: row.get(column) if not column.endswith("_") else row.get(
                column + "kernel_median_ms", row.get(column + "median_ms")) for row in select(mine, model=model)}
            if not values.get(18):
                continue
            points = sorted((sides, value / values[18]) for sides, value in values.items() if value)
            axes.plot(*zip(*points), ".-", label=model)
        axes.set(xlabel="sides", xticks=[6, 14, 18, 26], ylabel="of that of 18 sides", title=f"{title} ({backend})")
        axes.grid(True, alpha=0.25)
        if axes.lines:
            axes.legend(fontsize=6)
    save(figure, folder, "study_degree")


def front(rows, folder, save):
    """The front against full traversals, step by step: volume tests and time."""
    scenes = in_order(select(rows, part="traversal"), "model")
    wanted = [variant for variants in FRONTS for variant in variants[:3]]
    known = [row for row in select(rows, part="traversal") if row["variant"] in wanted and row.get("volume_tests")]
    if not known:
        return
    figure, all_axes = plt.subplots(len(scenes), 2, figsize=(13, 4.5 * len(scenes)), squeeze=False)
    for scene, line in zip(scenes, all_axes):
        for variant in wanted:
            steps = sorted(select(known, model=scene, variant=variant), key=lambda row: row["step"])
            steps = [row for row in steps if row["step"] > 0 and "broad_ms" in row]
            dash = "--" if variant.startswith("host") else "-"
            for axes, column in zip(line, ("volume_tests", "broad_ms")):
                if steps:
                    axes.plot([row["step"] for row in steps], [row[column] for row in steps], dash, label=variant)
        rest = [row["step"] for row in known if row["model"] == scene and row.get("phase") == "rest"]
        for axes, label in zip(line, ("volume tests", "broad phase, ms")):
            if rest:
                axes.axvline(min(rest), color="grey", linewidth=0.8)
            axes.set(xlabel="step; at rest to the right of the line", ylabel=label, yscale="log",
                     title=f"{scene}: front and full traversals")
            axes.grid(True, alpha=0.25)
            axes.legend(fontsize=7)
    save(figure, folder, "study_front")


def draw(rows, folder, save):
    for scene in in_order(select(rows, part="traversal"), "model"):
        descent(rows, scene, folder, save)
    levels(rows, folder, save)
    by_model(rows, "construction", "construction (tables 4.2 and 4.3)", folder, save)
    by_model(rows, "refit", "refit (table 4.4)", folder, save)
    compaction(rows, folder, save)
    quality(rows, folder, save)
    degree(rows, folder, save)
    front(rows, folder, save)
    triangle_tests(rows, folder, save)
