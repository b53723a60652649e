"""Plots of study.csv: the thesis's figures, each with what is measured today."""
import matplotlib.pyplot as plt

from results import in_order, select


def descent(rows, scene, folder, save):
    """Figures 4.6 and 4.8 (traversal) over a cloth's descent, and its narrow phase."""
    mine = select(rows, part="traversal", model=scene)
    if not mine:
        return
    variants = in_order(mine, "variant")
    figure, (by_overlaps, by_step, narrow) = plt.subplots(1, 3, figsize=(16, 4.5))
    for variant in variants:
        steps = sorted(select(mine, variant=variant), key=lambda row: row["step"])
        # The first step of a pass follows the last: no step of the descent.
        steps = [row for row in steps if row["step"] > 0 and "broad_ms" in row]
        label = variant if variant != "host" else "host, 1 thread"
        overlaps = sorted((row["candidates"], row["broad_ms"]) for row in steps)
        by_overlaps.plot(*zip(*overlaps), ".-", markersize=4, linewidth=0.8, label=label)
        by_step.plot([row["step"] for row in steps], [row["broad_ms"] for row in steps], label=label)
        pairs = sorted((row["candidates"], row["narrow_ms"]) for row in steps if row["candidates"] > 0)
        if pairs and variant in ("host", "default"):
            narrow.plot(*zip(*pairs), ".-", markersize=4, linewidth=0.8, label=label)
    by_overlaps.set(xlabel="overlaps found", ylabel="broad phase, ms", yscale="log",
                    title="traversal against overlaps (figure 4.6)")
    by_step.set(xlabel="step of the descent", ylabel="broad phase, ms", yscale="log",
                title="traversals over a simulation (figure 4.8)")
    narrow.set(xlabel="pairs tested", ylabel="narrow phase, ms", xscale="log", yscale="log",
               title="narrow phase against pairs")
    for axes in (by_overlaps, by_step, narrow):
        axes.grid(True, alpha=0.25)
        axes.legend(fontsize=7)
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
    for variant in in_order(mine, "variant"):
        for threads in in_order(select(mine, variant=variant), "threads"):
            chosen = select(mine, variant=variant, threads=threads)
            points = sorted((row["triangles"], time_of(row)) for row in chosen)
            dash = "-" if chosen[0]["backend"] in ("opencl", "host") else "--"
            label = variant + (f", {threads:.0f} thread(s)" if threads else "")
            axes.plot(*zip(*points), dash, marker=".", markersize=5, linewidth=0.9, label=label)
    axes.set(xscale="log", yscale="log", xlabel="triangles", ylabel="ms (kernel time; wall time on CPU threads)",
             title=title)
    axes.grid(True, which="both", alpha=0.25)
    axes.legend(fontsize=6, ncol=2)
    save(figure, folder, "study_" + part)


def quality(rows, folder, save):
    """Nodes a query meets against the time to build: to the left and below is better."""
    mine = [row for row in select(rows, part="quality") if time_of(row) is not None]
    for model in in_order(mine, "model"):
        figure, axes = plt.subplots(figsize=(7, 4.5))
        for row in select(mine, model=model):
            axes.plot(time_of(row), row["visits"], "o")
            axes.annotate(row["variant"], (time_of(row), row["visits"]), fontsize=7, xytext=(4, 3),
                          textcoords="offset points")
        axes.set(xscale="log", xlabel="construction, ms", ylabel="volume tests of a step",
                 title=f"quality against build time, {model}")
        axes.grid(True, alpha=0.25)
        save(figure, folder, f"study_quality_{model}")


def draw(rows, folder, save):
    for scene in in_order(select(rows, part="traversal"), "model"):
        descent(rows, scene, folder, save)
    levels(rows, folder, save)
    by_model(rows, "construction", "construction (tables 4.2 and 4.3)", folder, save)
    by_model(rows, "refit", "refit (table 4.4)", folder, save)
    quality(rows, folder, save)
    triangle_tests(rows, folder, save)
