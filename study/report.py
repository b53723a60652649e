#!/usr/bin/env python3
"""Makes the thesis's tables with today's figures beside them: report.py CSV… [--tables FILE] [--plots DIR]

Replaces the tables between their markers in FINDINGS.md here; its text is written by hand. With --tables, writes the
tables alone to FILE instead. With --plots, draws the thesis's figures into DIR, which needs python3-matplotlib.
"""
import argparse
import csv
import os
import re
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "benchmarks"))
from results import count, figure, in_order, read_csv, select, table

# The thesis's models, and the models that stand in for them.
THESIS_MODELS = {"terrain_6272": "Biplane", "torus_16301": "Small Bunny", "bunny": "Large Bunny",
                 "torus_345944": "Armadillo", "dragon": "Dragon", "bunny_1m": "Happy Buddha"}
PHASES = {"descent": "coming down", "rest": "at rest"}


def thesis(number, what):
    with open(os.path.join(HERE, "thesis.csv"), newline="") as file:
        return {row["model"]: float(row["ms"]) for row in csv.DictReader(file)
                if row["table"] == number and row["what"] == what}


def time_of(row):
    """Returns kernel time on a device, wall time on CPU threads."""
    return row.get("kernel_ms", row.get("median_ms"))


def by_model(machines, part, published):
    lines = []
    for label, number, what in published:
        lines.append(["*thesis*", f"*{label}*"] + [f"*{count(thesis(number, what).get(name))}*"
                                                   for name in THESIS_MODELS.values()])
    for machine, rows in machines:
        mine = select(rows, part=part)
        for variant in in_order(mine, "variant"):
            for threads in dict.fromkeys(row.get("threads", 0) for row in select(mine, variant=variant)):
                times = {row["model"]: time_of(row) for row in select(mine, variant=variant)
                         if row.get("threads", 0) == threads}
                name = variant.replace("_", " ") + (f", {threads:.0f} thread" + "s" * (threads > 1) if threads else "")
                lines.append([machine, name] + [figure(times.get(model)) for model in THESIS_MODELS])
    return table(["machine", "method"] + [f"{name} ({model.replace('_', ' ')})"
                                          for model, name in THESIS_MODELS.items()], lines)


def construction(machines):
    return by_model(machines, "construction", (("CPU", "4.2", "cpu"), ("Quadro, normal", "4.2", "quadro_normal"),
                                               ("Quadro, optimised", "4.2", "quadro_optimised"),
                                               ("Tesla, optimised", "4.3", "tesla_optimised")))


def refit(machines):
    return by_model(machines, "refit", (("CPU", "4.4", "cpu"), ("Quadro", "4.4", "quadro")))


def span(ratios, digits=2):
    if not ratios:
        return "–"
    low, high = f"{min(ratios):,.{digits}f}", f"{max(ratios):,.{digits}f}"
    return low if low == high else f"{low} to {high}"


def ratios_of(rows, part, slow, fast):
    """Returns by how many times `fast` beats `slow` on each model."""
    times = [{row["model"]: time_of(row) for row in select(rows, part=of, variant=variant)}
             for of, variant in ((part[0], slow), (part[-1], fast))]
    return [times[0][model] / times[1][model] for model in times[0] if model in times[1]]


def traversals(rows, slow, fast):
    found = []
    for row in select(rows, part="traversal", variant=fast):
        found += [other["broad_ms"] / row["broad_ms"]
                  for other in select(rows, part="traversal", variant=slow, model=row["model"],
                                                                          phase=row["phase"])]
    return found


def tests(rows):
    """Returns the ratio on the largest number of pairs."""
    found = [max(select(rows, part="triangle_tests", variant="Möller", backend=backend), key=lambda row: row["pairs"],
                 default=None) for backend in ("host", "opencl")]
    return [time_of(found[0]) / time_of(found[1])] if all(found) else []


def published(slow, fast):
    return span([thesis(*slow)[model] / thesis(*fast)[model] for model in THESIS_MODELS.values()], 1)


NORMAL, ADAPTIVE, SMALL, ALL, LEVELS = ("thesis: normal", "thesis: adaptive groups", "thesis: and small splits",
                                        "thesis: all optimisations", "thesis: launch per level")
BUILD = ("construction",)
SPEEDUPS = (
    ("adaptive group sizes over the plain builder", "1.67 (Happy Buddha)",
     lambda rows: ratios_of(rows, BUILD, NORMAL, ADAPTIVE)),
    ("small splits, added to it", "1.5 to 2", lambda rows: ratios_of(rows, BUILD, ADAPTIVE, SMALL)),
    ("large nodes, added to it", "1.7 (Happy Buddha)", lambda rows: ratios_of(rows, BUILD, SMALL, ALL)),
    ("all optimisations over the plain builder", published(("4.2", "quadro_normal"), ("4.2", "quadro_optimised")),
     lambda rows: ratios_of(rows, BUILD, NORMAL, ALL)),
    ("optimised builder over one CPU thread", published(("4.2", "cpu"), ("4.2", "quadro_optimised")),
     lambda rows: ratios_of(rows, BUILD, "host, top-down", ALL)),
    ("refit, a launch per level, over one CPU thread", published(("4.4", "cpu"), ("4.4", "quadro")),
     lambda rows: ratios_of(rows, ("refit",), "host", LEVELS)),
    ("refit over optimised construction", "10", lambda rows: ratios_of(rows, ("construction", "refit"), ALL, LEVELS)),
    ("simple traversal over one CPU thread", "25",
     lambda rows: traversals(rows, "host, thesis: simple", "thesis: simple")),
    ("front over simple traversal", "more than 1", lambda rows: traversals(rows, "thesis: simple", "thesis: front")),
    ("Möller's test over one CPU thread, 1 M pairs", "grows with the pairs", tests),
)


def speedups(machines):
    return table(["how many times as fast", "thesis"] + [name for name, _ in machines],
                 [[what, found] + [span(of(rows)) for _, rows in machines] for what, found, of in SPEEDUPS])


def compaction(machines):
    lines = [[name] + [f"{100 * row['share']:.1f} %" for model in THESIS_MODELS
                       for row in select(rows, part="compaction", model=model)]
             for name, rows in machines if select(rows, part="compaction")]
    return table(["machine"] + list(THESIS_MODELS.values()), [line for line in lines if len(line) == 7])


def steps_table(machines, part):
    lines = []
    for name, rows in machines:
        mine = select(rows, part=part)
        for variant in in_order(mine, "variant"):
            line = [name, variant]
            for scene in ("thesis", "fine"):
                for phase in PHASES:
                    row = next(iter(select(mine, variant=variant, model=scene, phase=phase)), {})
                    stages = sum(row.get(stage, 0) for stage in ("refit_ms", "broad_ms", "narrow_ms", "order_ms"))
                    line.append(f"{count(row.get('volume_tests'))} / {figure(row['broad_ms'])} / {figure(stages)}"
                                if row else "–")
            lines.append(line)
    phases = [f"{scene}, {phase}" for scene in ("thesis", "fine") for phase in PHASES.values()]
    return table(["machine", part] + phases, lines)


def traversal(machines):
    return steps_table(machines, "traversal")


def builder(machines):
    return steps_table(machines, "builder")


def obstacles(machines):
    """Whole steps beside the largest model."""
    lines, variants = [], ("nothing happens", "one comes", "one goes", "two move")
    for name, rows in machines:
        for backend in ("host", "opencl"):
            times = {row["variant"]: row.get("median_ms")
                     for row in select(rows, part="obstacles", model="bunny_1m", backend=backend)}
            if times:
                lines.append([name, backend] + [figure(times.get(variant)) for variant in variants])
    return table(["machine", "on", "nothing changes", "one obstacle is added", "one is removed", "two move"], lines)


def triangle_tests(machines):
    lines = []
    for name, rows in machines:
        mine = select(rows, part="triangle_tests")
        for backend in in_order(mine, "backend"):
            for variant in in_order(mine, "variant"):
                points = sorted((row["pairs"], time_of(row)) for row in select(mine, backend=backend, variant=variant))
                lines.append([name, backend, variant,
                              "; ".join(f"{count(pairs)}: {figure(time)}" for pairs, time in points)])
    return table(["machine", "on", "test", "pairs: ms"], lines)


def quality(machines):
    """Trees of the largest model."""
    lines = []
    for name, rows in machines:
        for row in sorted(select(rows, part="quality", model="bunny_1m"), key=lambda row: row["volume_tests"]):
            lines.append([name, row["variant"], row["backend"], figure(time_of(row)), count(row["volume_tests"])])
    return table(["machine", "builder", "on", "construction, ms", "volume tests of a step"], lines)


LEAF_SIZES = (1, 2, 4, 8, 16)


def shape(machines):
    lines = []
    for name, rows in machines:
        for backend in ("host", "opencl"):
            for children in ("2 children", "4 children"):
                mine = [row for row in select(rows, part="shape", model="bunny_1m", backend=backend)
                        if row["variant"].startswith(children)]
                if len(mine) == len(LEAF_SIZES):
                    lines.append([name, backend, children]
                                 + [f"{figure(row['median_ms'])} / {count(row['volume_tests'])}" for row in mine])
    return table(["machine", "on", "nodes"] + [f"leaves of {size}" for size in LEAF_SIZES], lines)


def degree(machines):
    lines = []
    for name, rows in machines:
        for backend in ("host", "opencl"):
            for sides in (6, 14, 18, 26):
                mine = select(rows, part="degree", backend=backend, dop=sides)
                trees = {row["stage"]: row for row in select(mine, model="bunny_1m")}
                whole = [next((row for row in select(mine, model=scene, stage="step")
                               if row["variant"].endswith(("host", "default"))), {}) for scene in ("thesis", "fine")]
                if trees:
                    lines.append([name, backend, str(sides)] + [figure(time_of(trees[stage]))
                                                                for stage in ("build", "refit", "walk")]
                                 + [count(trees["walk"]["candidates"])] + [figure(row.get("median_ms"))
                                                                           for row in whole])
    return table(["machine", "on", "sides", "construction, ms", "refit, ms", "traversal, ms", "candidates",
                  "step, thesis, ms",
                  "step, fine, ms"], lines)


TABLES = {"speedups": speedups, "construction": construction, "compaction": compaction, "refit": refit,
          "traversal": traversal, "builder": builder, "triangle_tests": triangle_tests, "quality": quality,
          "shape": shape, "degree": degree, "obstacles": obstacles}


def update_findings(path, machines):
    with open(path) as file:
        text = file.read()
    for name, make in TABLES.items():
        marked = re.compile(f"(<!-- {name} -->\n).*?(<!-- end -->)", re.DOTALL)
        if not marked.search(text):
            sys.exit(f"report.py: {path} has no markers of the table {name}")
        text = marked.sub(lambda match: match[1] + "\n" + make(machines) + match[2], text)
    with open(path, "w") as file:
        file.write(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("csv", nargs="+")
    parser.add_argument("--tables", help="file of the tables alone")
    parser.add_argument("--plots", help="folder of the plots")
    arguments = parser.parse_args()
    machines = [(os.path.basename(path)[:-4], read_csv(path)) for path in arguments.csv]
    if arguments.tables:
        with open(arguments.tables, "w") as file:
            file.write("".join(f"## {name.replace('_', ' ')}\n\n{make(machines)}" for name, make in TABLES.items()))
    else:
        update_findings(os.path.join(HERE, "FINDINGS.md"), machines)
    if arguments.plots:
        import plots  # needs matplotlib, which the tables do without
        os.makedirs(arguments.plots, exist_ok=True)
        for name, rows in machines:
            plots.draw(os.path.join(arguments.plots, name), rows)


if __name__ == "__main__":
    main()
