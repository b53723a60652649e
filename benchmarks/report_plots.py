"""Plots of the reduced results: whole steps over the sweeps, and errors against run time. Needs python3-matplotlib."""
import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

from results import in_order, select

# Equal data gives an equal file, and text stays text.
plt.rcParams.update({"svg.hashsalt": "drape", "svg.fonttype": "none", "font.size": 8})


def panels(count, columns):
    lines = (count + columns - 1) // columns
    drawn, grid = plt.subplots(lines, columns, figsize=(4.2 * columns, 3.3 * lines + 0.5), squeeze=False)
    for unused in grid.flat[count:]:
        unused.set_visible(False)
    return drawn, list(grid.flat)[:count]


def finish(drawn, all_axes, path, columns):
    entries = {}
    for axes in all_axes:
        entries.update(dict(zip(*reversed(axes.get_legend_handles_labels()))))
        axes.grid(True, alpha=0.25)
    drawn.legend(entries.values(), entries.keys(), loc="lower center", ncol=columns)
    drawn.tight_layout(rect=(0, 0.5 / drawn.get_figheight(), 1, 1))
    drawn.savefig(path, metadata={"Date": None})
    plt.close(drawn)


def draw_steps(path, rows, sweeps, methods):
    shown = [sweep for sweep in sweeps if select(rows, setting=sweep)]
    drawn, all_axes = panels(len(shown), 4)
    for sweep, axes in zip(shown, all_axes):
        size, label = sweeps[sweep]
        for index, method in enumerate(methods):
            points = sorted((size(row), row["median_ms"]) for row in select(rows, setting=sweep, method=method)
                            if "median_ms" in row)
            if points:
                axes.plot(*zip(*points), "-" if method.startswith("drape") else "--", color=f"C{index}", marker=".",
                          label=methods[method])
        axes.set(xscale="log", yscale="log", xlabel=label, ylabel="whole step, ms")
    finish(drawn, all_axes, path, 3)


COLOURS = {"drape": ("C0", "Drape, device"), "drape_host": ("C2", "Drape, host"), "bullet": ("C3", "Bullet's own")}


def draw_errors(path, rows):
    """One row of panels for each error, one panel for each scene. Values of zero lie on the bottom line."""
    scenes = in_order(rows, "scene")
    errors = (("penetration_mm", "deepest penetration, mm"), ("nodes_through", "nodes through"))
    drawn, all_axes = panels(len(scenes) * len(errors), len(scenes))
    pairs = [(error, scene) for error in errors for scene in scenes]
    for ((column, label), scene), axes in zip(pairs, all_axes):
        for method, (colour, name) in COLOURS.items():
            points = [(row["median_ms"], row[column]) for row in select(rows, scene=scene, method=method, ended="whole")
                      if column in row and not row["setting"].startswith("rest")]
            if points:
                axes.plot(*zip(*points), "o", color=colour, markersize=3, alpha=0.7, label=name)
        axes.set(xscale="log", title=scene, xlabel="frame, ms", ylabel=label)
        least = 0.1 if column == "penetration_mm" else 1  # linear below
        axes.set_yscale("symlog", linthresh=least)
        axes.set_ylim(-least / 2, None)
    finish(drawn, all_axes, path, 3)


def draw(prefix, rows, sweeps, methods):
    steps, errors = select(rows, program="bench_step", stage="step"), select(rows, program="error_vs_time")
    if any(row.get("setting") for row in steps):
        draw_steps(prefix + "_steps.svg", steps, sweeps, methods)
    if errors:
        draw_errors(prefix + "_errors.svg", errors)
