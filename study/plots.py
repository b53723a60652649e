"""The thesis's figures from the reduced results: draws NAME_levels.svg, NAME_models.svg and NAME_tests.svg."""
import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

from results import in_order, select

# Equal data gives an equal file; text stays text.
plt.rcParams.update({"svg.hashsalt": "drape", "svg.fonttype": "none", "font.size": 8})


def lines(axes, rows, x, y, title, xlabel, logarithmic_x=True):
    """Draws a line for each variant, back end and number of threads."""
    styles = {"opencl": "-", "host": "--"}
    for variant in in_order(rows, "variant"):
        for backend in in_order(select(rows, variant=variant), "backend"):
            for threads in dict.fromkeys(row.get("threads", 0)
                                         for row in select(rows, variant=variant, backend=backend)):
                points = sorted((row[x], y(row)) for row in select(rows, variant=variant, backend=backend)
                                if row.get("threads", 0) == threads and y(row) is not None)
                if points:
                    axes.plot(*zip(*points), styles.get(backend, ":"), marker=".", linewidth=0.9,
                              label=variant + (f", {threads:.0f} thread(s)" if threads else ""))
    axes.set(xscale="log" if logarithmic_x else "linear", yscale="log", title=title, xlabel=xlabel,
             ylabel="ms (kernel time; wall time of CPU threads)")
    axes.grid(True, alpha=0.25)
    if axes.lines:
        axes.legend(fontsize=5)


def time_of(row):
    return row.get("kernel_ms", row.get("median_ms"))


def figure_of(path, panels):
    drawn, all_axes = plt.subplots(1, len(panels), figsize=(7 * len(panels), 4.5), squeeze=False)
    for axes, panel in zip(all_axes.flat, panels):
        lines(axes, *panel)
    drawn.tight_layout()
    drawn.savefig(path, metadata={"Date": None})
    plt.close(drawn)


def draw(prefix, rows):
    figure_of(prefix + "_models.svg", [
        (select(rows, part="construction"), "triangles", time_of, "construction (tables 4.2 and 4.3)", "triangles"),
        (select(rows, part="refit"), "triangles", time_of, "refit (table 4.4)", "triangles")])
    figure_of(prefix + "_levels.svg", [
        (select(rows, part="levels"), "level", time_of, "construction by level (figures 4.2 to 4.4)", "level, root 0",
         False),
        (select(rows, part="refit_levels"), "level", time_of, "refit by height (figure 4.10)", "height, leaves 0",
         False)])
    figure_of(prefix + "_tests.svg", [
        (select(rows, part="triangle_tests"), "pairs", time_of, "tests of triangle pairs (figure 4.9)",
         "pairs of triangles")])
