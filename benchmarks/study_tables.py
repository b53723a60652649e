"""Tables of study.csv beside the thesis's own figures."""
import csv
import os

from results import in_order, select

HERE = os.path.dirname(os.path.abspath(__file__))

# The models of the thesis and those that stand in for them.
THESIS_MODELS = {
    "terrain_6272": "Biplane",
    "torus_16301": "Small Bunny",
    "bunny": "Large Bunny",
    "torus_345944": "Armadillo",
    "dragon": "Dragon",
    "bunny_1m": "Happy Buddha",
}


def thesis(table, what):
    with open(os.path.join(HERE, "thesis.csv"), newline="") as file:
        return {row["model"]: float(row["ms"]) for row in csv.DictReader(file)
                if row["table"] == table and row["what"] == what}


def time_text(row, figure):
    """Kernel time and host-to-host time where both were taken, else wall time."""
    if "kernel_median_ms" in row:
        return f"{figure(row['kernel_median_ms'])} / {figure(row['median_ms'])}"
    return figure(row["median_ms"])


def with_commits(rows, part, text):
    """A part's tables, where there are any, and the commits of the rows that they are made of."""
    commits = in_order(select(rows, part=part), "commit")
    return text + f"*Measured at {', '.join(commits)}.*\n\n" if text and commits else text


def by_model(rows, part, title, thesis_columns, table, figure):
    mine = [row for row in select(rows, part=part) if "median_ms" in row]
    models = in_order(mine, "model")
    if not models:
        return ""
    lines = []
    for variant in in_order(mine, "variant"):
        for threads in in_order(select(mine, variant=variant), "threads"):
            chosen = {row["model"]: row for row in select(mine, variant=variant, threads=threads)}
            name = variant.replace("_", " ") + (f", {threads:.0f} thread" + "s" * (threads > 1) if threads else "")
            lines.append([name] + [time_text(chosen[model], figure) if model in chosen else "–" for model in models])
    for label, source, what in thesis_columns:
        figures = thesis(source, what)
        lines.append([f"*thesis: {label}*"] + [
            f"*{figures[THESIS_MODELS[model]]:,.0f}*" if model in THESIS_MODELS else "–" for model in models])
    triangles = {row["model"]: row["triangles"] for row in mine}
    head = [""] + [f"{model.replace('_', ' ')} ({triangles[model]:,.0f})" for model in models]
    return title + "\n\n" + table(head, lines)


def descent_steps(rows, scene, variant, phase="descent"):
    """Steps of a phase. The first step of a pass follows the last, so it is none; nor is one without a time."""
    return [row for row in select(rows, part="traversal", model=scene, variant=variant)
            if row["step"] > 0 and row.get("phase", "descent") == phase and "broad_ms" in row]


def mean(steps, column):
    found = [row[column] for row in steps if row.get(column)]
    return sum(found) / len(found) if found else None


def median(values):
    ordered, half = sorted(values), len(values) // 2
    if not ordered:
        return None
    return ordered[half] if len(ordered) % 2 else (ordered[half - 1] + ordered[half]) / 2


def count(value):
    return "–" if value is None else f"{value:,.0f}"


def descent_table(rows, table, figure):
    text = ""
    for scene in in_order(select(rows, part="traversal"), "model"):
        lines = []
        for variant in in_order(select(rows, part="traversal", model=scene), "variant"):
            steps = descent_steps(rows, scene, variant)
            if not steps:
                continue
            total = [sum(row.get(stage + "_ms", 0) for row in steps) / len(steps)
                     for stage in ("refit", "broad", "narrow", "order", "step")]
            lines.append([variant] + [figure(value) for value in total] + [count(mean(steps, "volume_tests"))])
        text += (f"Descent of the {scene} scene's cloth onto the bunny, mean of its steps, ms (kernel time on a device, of a queue "
                 "that is profiled; the whole step host to host), figures 4.6 and 4.8:\n\n"
                 + table(["traversal", "refit", "broad phase", "narrow phase", "order", "step, host to host", "volume tests"],
                         lines))
    return text


# The front, the traversals without one (the same but for it, and the thesis's), and what is fastest.
FRONTS = (("host, thesis: front", "host, as front, from the roots", "host, thesis: simple", "host, eight wide"),
          ("thesis: front", "as front, from fixed pairs", "thesis: simple", "groups, eight wide", "leaves, eight wide",
           "default"))


def front_cells(steps, front, figure):
    """Volume tests, ms of the broad phase, of all stages and host to host; in brackets the front's share of the first two."""
    cells = []
    for column, text in (("volume_tests", count), ("broad_ms", figure)):
        value, least = mean(steps, column), mean(front, column)
        ratio = f" ({least / value:.2f})" if value and least and steps is not front else ""
        cells.append("–" if value is None else text(value) + ratio)
    stages = ("refit_ms", "broad_ms", "narrow_ms", "order_ms")
    whole = sum(row.get(stage, 0) for row in steps for stage in stages)
    return cells + ([figure(whole / len(steps)), figure(mean(steps, "step_ms"))] if steps else ["–", "–"])


def phase_table(table, what, columns, lines):
    """columns: with a place for the phase, for coming down and then for rest."""
    headings = [text.format(phase) for phase in ("coming down", "at rest") for text in columns]
    return table(["scene", what] + headings, lines)


def front_table(rows, table, figure):
    """What the front saves as the cloth comes down, and as it sways at rest."""
    lines = []
    for scene in in_order(select(rows, part="traversal"), "model"):
        for variants in FRONTS:
            for variant in variants:
                line = [scene, variant]
                for phase in ("descent", "rest"):
                    front = descent_steps(rows, scene, variants[0], phase)
                    steps = front if variant == variants[0] else descent_steps(rows, scene, variant, phase)
                    line += front_cells(steps, front, figure)
                if any(cell != "–" for cell in line[2:]):
                    lines.append(line)
    if not lines:
        return ""
    columns = ["volume tests, {}", "broad phase, ms", "all stages, ms", "step, host to host, ms"]
    return ("The front against traversals without one, means of steps (kernel time on a device, but for the last); in brackets what the front "
            "takes of it. The default finds pairs of features, the others of triangles.\n\n"
            + phase_table(table, "traversal", columns, lines))


def pair_text(row, prefix, figure):
    """Kernel time / host to host, or wall time; prefix: of the column."""
    if prefix + "median_ms" not in row:
        return "–"
    kernel = row.get(prefix + "kernel_median_ms")
    return (f"{figure(kernel)} / " if kernel is not None else "") + figure(row[prefix + "median_ms"])


def degree_table(rows, table, figure):
    mine = select(rows, part="degree")
    trees, steps = [], []
    for model in in_order(mine, "model"):
        for backend in in_order(select(mine, model=model), "backend"):
            ordered = sorted(select(mine, model=model, backend=backend), key=lambda row: row["dop"])
            place = "host, 1 thread" if backend == "host" else "device"
            trees += [[model, place, f"{row['dop']:.0f}"]
                      + [pair_text(row, prefix, figure) for prefix in ("build_", "refit_", "walk_")]
                      + [count(row["visits"]), count(row["candidates"]), count(row["contacts"]),
                         f"{row['bytes'] / row['triangles']:,.0f}"]
                      for row in ordered if "walk_median_ms" in row]
            for variant in in_order([row for row in ordered if "step_median_ms" in row], "variant"):
                what = variant.partition(", step, ")[2]
                row = select(ordered, variant=variant)[0]
                steps.append((place_of(model, mine), what, row["dop"],
                              [model, what, f"{row['dop']:.0f}", pair_text(row, "step_", figure), count(row.get("visits")),
                               count(row["candidates"]), count(row["contacts"]),
                               f"{row['bytes'] / 2 ** 20:,.1f}" if "bytes" in row else "–"]))
    text = ""
    if trees:
        text += ("Sides of the volumes: a radix tree of each model, the thesis's cloth looking for its candidates in it; ms: "
                 "kernel time / host to host on a device. The contacts of the candidates are the same for all, bit for "
                 "bit.\n\n" + table(["model", "on", "sides", "construction", "refit", "traversal", "volume tests",
                                     "candidates", "contacts", "bytes a triangle"], trees))
    if steps:
        steps.sort(key=lambda entry: entry[:3])
        text += ("Whole steps in volumes of so many sides, mean of the scene's steps, ms likewise; the default's candidates "
                 "are pairs of features, the others' of triangles.\n\n"
                 + table(["scene", "traversal", "sides", "step", "volume tests", "candidates", "contacts",
                          "device memory, MiB"], [line for *_, line in steps]))
    return text


def place_of(model, rows):
    return in_order(rows, "model").index(model)


def shape_table(rows, table, figure):
    """A line a shape, for every kind of volume that was measured; two columns of times a model."""
    mine = [row for row in select(rows, part="shape") if "median_ms" in row]
    models = in_order(mine, "model")
    lines = []
    for dop in in_order(mine, "dop"):
        for backend in in_order(mine, "backend"):
            for variant in in_order(mine, "variant"):
                line = [f"{dop:.0f}-DOP, {variant}" + (", host, 1 thread" if backend == "host" else "")]
                for model in models:
                    found = select(mine, dop=dop, backend=backend, variant=variant, model=model)
                    line.append(f"{found[0]['visits']:,.0f} / {figure(found[0]['median_ms'])} / "
                                f"{figure(found[0]['refit_median_ms'])}" if found else "–")
                lines.append(line)
    if not lines:
        return ""
    return ("Shapes of a radix tree: volume tests when the thesis's cloth looks for its candidates, ms for that, and ms for a "
            "refit (kernel time on a device; by the step's launch a height, which takes any shape, not by subtrees).\n\n" + table(["shape"] + [model.replace("_", " ") for model in models], lines))


BUILDER_STAGES = ("step_ms", "refit_ms", "broad_ms")


def builder_table(rows, table, figure):
    """Whole steps of the host by the builder of its trees; in brackets the step over the default's."""
    mine = [row for row in select(rows, part="builder") if "step_ms" in row and row["step"] > 0]
    lines = []
    for scene in in_order(mine, "model"):
        medians = {}
        for variant in in_order(select(mine, model=scene), "variant"):
            line = [scene, variant.replace("host, ", "")]
            for phase in ("descent", "rest"):
                steps = select(mine, model=scene, variant=variant, phase=phase)
                times = [median([row[stage] for row in steps if stage in row]) for stage in BUILDER_STAGES]
                first = medians.setdefault(phase, times[0])
                ratio = f" ({times[0] / first:.2f})" if times[0] is not None and first else ""
                line += [figure(times[0]) + ratio] + [figure(time) for time in times[1:]] + [count(mean(steps, "volume_tests"))]
            lines.append(line)
    if not lines:
        return ""
    columns = ["step, {}, ms", "refit", "broad phase", "volume tests"]
    return ("Whole steps of the host by the front, one thread, with every builder of both sides' trees: medians of steps, in "
            "brackets the step of that with the default builder; passes of the builders took turns.\n\n"
            + phase_table(table, "builder", columns, lines))


def refit_kernel_table(rows, table, figure):
    mine = select(rows, part="refit_kernels")
    if not mine:
        return ""
    models = in_order(mine, "model")
    lines = []
    for variant in in_order(mine, "variant"):
        for kernel in in_order(select(mine, variant=variant), "kernel"):
            line = [variant, kernel]
            for model in models:
                found = select(mine, variant=variant, kernel=kernel, model=model)
                line.append(figure(found[0]["kernel_median_ms"]) if found else "–")
            lines.append(line)
    return "The refits' kernels, ms:\n\n" + table(["refit", "kernel"] + [m.replace("_", " ") for m in models], lines)


def rebuild_table(rows, table, figure):
    """A line a variant: the whole run, and its second half, in which the cloth keeps its new shape."""
    mine = [row for row in select(rows, part="rebuild") if "step_ms" in row]
    if not mine:
        return ""
    lines = []
    for scene in in_order(mine, "model"):
        for variant in in_order(select(mine, model=scene), "variant"):
            steps = sorted(select(mine, model=scene, variant=variant), key=lambda row: row["step"])
            late = steps[len(steps) // 2:]
            cells = [f"{sum(row.get('rebuilds', 0) for row in steps):.0f}"]
            for chosen in (steps, late):
                tests = [row["volume_tests"] for row in chosen if row.get("volume_tests")]
                cells.append(f"{sum(tests) / len(tests):,.0f}" if tests else "–")
            for chosen in (steps, late):
                cells.append(figure(sum(row.get("broad_ms", 0) for row in chosen) / len(chosen)))
            lines.append([scene, variant] + cells)
    return ("A cloth that changes its shape in the first half of a run and keeps it in the second, with its hierarchy built "
            "anew where it decayed and without: means of all steps, and of the second half. Broad phase in ms, kernel time "
            "on a device; building is not in it.\n\n"
            + table(["scene", "variant", "rebuilds", "volume tests", "second half", "broad phase", "second half"], lines))


def obstacle_table(rows, table, figure):
    mine = [row for row in select(rows, part="obstacles") if "median_ms" in row]
    if not mine:
        return ""
    events = in_order(mine, "variant")
    lines = []
    for backend in in_order(mine, "backend"):
        for model in in_order(select(mine, backend=backend), "model"):
            steps = select(mine, backend=backend, model=model)
            times = [select(steps, variant=event)[0]["median_ms"] for event in events]
            lines.append([model, f"{steps[0]['triangles']:,.0f}", "host, one thread" if backend == "host" else "device"]
                         + [figure(time) for time in times])
    return ("Whole steps, ms, of a cloth of 512 triangles on the model in which an obstacle of 320 comes or goes, or two move, "
            "of which one came before the model and one after it: medians.\n\n"
            + table(["model", "triangles", "back end"] + events, lines))


def compaction_table(rows, table):
    mine = select(rows, part="compaction")
    if not mine:
        return ""
    lines = [[row["model"], f"{100 * row['share']:.1f} %"] for row in mine]
    return ("Share of the compaction in the thesis's construction with all optimisations, kernel time (figure 4.5; the "
            "thesis calls it small and shrinking with the model). Here it is of every level's queue; the thesis compacts "
            "only in levels with leaves:\n\n" + table(["model", "share"], lines))


def triangle_test_table(rows, table, figure):
    mine = [row for row in select(rows, part="triangle_tests") if "median_ms" in row]
    if not mine:
        return ""
    lines = []
    for backend in in_order(mine, "backend"):
        for variant in in_order(mine, "variant"):
            chosen = select(mine, backend=backend, variant=variant)
            name = variant + (", host, 1 thread" if backend == "host" else "")
            lines.append([name] + [time_text(row, figure) for row in chosen] + [f"{chosen[-1]['hits']:,.0f}"])
    counts = [f"{count:,.0f} pairs" for count in in_order(mine, "pairs")]
    return ("Tests of triangle pairs (figure 4.9), ms likewise, and what the last column's pairs are said to meet. "
            "Möller's test has an absolute tolerance, as published: on triangles of millimetres it reports most that are "
            "near. The certified one reports what meets and what nearly touches.\n\n"
            + table(["test"] + counts + ["meet"], lines))


def quality_table(rows, table, figure):
    text = ""
    for model in in_order(select(rows, part="quality"), "model"):
        lines = [[row["variant"], time_text(row, figure), f"{row['cost']:,.1f}", f"{row['volume_m3']:.3g}",
                  f"{row['height']:.0f}", f"{row['visits']:,.0f}"]
                 for row in select(rows, part="quality", model=model) if "median_ms" in row]
        text += f"Trees of the {model}: build time (kernel / host to host, ms) against quality.\n\n" + table(
            ["builder", "build", "SAH cost", "volume, m³", "height", "volume tests of 2,048 queries"], lines)
    return text


# Of the thesis's builders its last, and today's, on every machine.
COMPARED = ("thesis: normal", "thesis: all optimisations", "balanced", "radix, 30 bits", "ploc")


def devices_table(machines, table, figure):
    """Table 4.3: the same construction on all devices. machines: name and rows."""
    devices, models, lines = [], {}, []
    for name, rows in machines:
        mine = [row for row in select(rows, part="construction", backend="opencl") if "kernel_median_ms" in row]
        devices += [(name, mine)] if mine else []
        models.update({row["model"]: row["triangles"] for row in mine})
    if len(devices) < 2:
        return ""
    ordered = sorted(models, key=models.get)
    for variant in COMPARED:
        for name, mine in devices:
            found = {row["model"]: row for row in select(mine, variant=variant)}
            lines.append([variant, name] + [time_text(found[model], figure) if model in found else "–" for model in ordered])
    for label, source, what in (("Quadro FX 3800", "4.3", "quadro_optimised"), ("Tesla C2050", "4.3", "tesla_optimised")):
        figures = thesis(source, what)
        lines.append(["*thesis, optimised, kernels*", f"*{label}*"] + [
            f"*{figures[THESIS_MODELS[model]]:,.0f}*" if model in THESIS_MODELS else "–" for model in ordered])
    return ("## Devices side by side\n\nConstruction on all devices (table 4.3), ms: kernel time / host to host; measured at "
            + ", ".join(f"{', '.join(in_order(mine, 'commit'))} ({name})" for name, mine in devices) + ".\n\n"
            + table(["builder", "device"] + [f"{model.replace('_', ' ')} ({models[model]:,.0f})" for model in ordered], lines))


def text(rows, table, figure):
    if not rows:
        return ""
    tables = (
        ("construction", by_model(
            rows, "construction",
            "Construction (tables 4.2 and 4.3), ms: kernel time / host to host for a device; wall time for CPU threads.",
            [("CPU", "4.2", "cpu"), ("Quadro FX 3800, normal, kernels", "4.2", "quadro_normal"),
             ("Quadro FX 3800, optimised, kernels", "4.2", "quadro_optimised"),
             ("Tesla C2050, optimised, kernels", "4.3", "tesla_optimised")], table, figure)),
        ("compaction", compaction_table(rows, table)),
        ("refit", by_model(rows, "refit", "Refit (table 4.4), ms, likewise.",
                              [("CPU", "4.4", "cpu"), ("Quadro FX 3800, kernels", "4.4", "quadro")], table, figure)),
        ("refit_kernels", refit_kernel_table(rows, table, figure)),
        ("quality", quality_table(rows, table, figure)),
        ("shape", shape_table(rows, table, figure)),
        ("degree", degree_table(rows, table, figure)),
        ("traversal", descent_table(rows, table, figure) + front_table(rows, table, figure)),
        ("builder", builder_table(rows, table, figure)),
        ("rebuild", rebuild_table(rows, table, figure)),
        ("obstacles", obstacle_table(rows, table, figure)),
        ("triangle_tests", triangle_test_table(rows, table, figure)))
    return "".join(with_commits(rows, part, text) for part, text in tables)
