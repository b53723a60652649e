"""What the study comes to: whether the front pays, the thesis's findings beside today's, and a ranking a stage.

All figures are taken from the results. machines: name and rows of study.csv, as in summary.py.
"""
from results import in_order, select
from study_tables import descent_steps, mean, time_text, thesis, THESIS_MODELS

PHASES = (("descent", "coming down"), ("rest", "at rest"))
STAGES = ("refit_ms", "broad_ms", "narrow_ms", "order_ms")

# The front, and the traversals without one that it is held against: the same but for it, and the thesis's.
FRONT, FULL, SIMPLE = "front", "the same without a front", "the thesis's simple traversal"
SIDES = (("device", {FRONT: "thesis: front", FULL: "as front, from fixed pairs", SIMPLE: "thesis: simple"}),
         ("host, 1 thread", {FRONT: "host, thesis: front", FULL: "host, as front, from the roots",
                             SIMPLE: "host, thesis: simple"}))
# What a step takes with the front, with the fastest other traversals of triangles, and with the default.
WHOLE = (("device", {FRONT: "thesis: front", "eight-wide nodes, by groups": "groups, eight wide",
                     "eight-wide nodes, by work-items": "leaves, eight wide", "the default": "default"}),
         ("host, 1 thread", {"front": "host, thesis: front", "eight-wide nodes": "host, eight wide"}))


def in_words(lowest, highest, digits=2):
    low, high = f"{lowest:,.{digits}f}", f"{highest:,.{digits}f}"
    return low if low == high else f"{low} to {high}"


def all_stages(steps):
    return sum(row.get(stage, 0) for row in steps for stage in STAGES) / len(steps) if steps else None


def scenes_of(machines):
    return list(dict.fromkeys(scene for _, rows in machines for scene in in_order(select(rows, part="traversal"), "model")))


def traversal_table(machines, sides, value_of, text, table):
    """A line a machine, side and traversal, a column a scene and phase; in brackets the first traversal's share."""
    scenes, lines, cases = scenes_of(machines), [], []
    for name, rows in machines:
        for side, variants in sides:
            values = {what: [value_of(descent_steps(rows, scene, variant, phase)) for scene in scenes for phase, _ in PHASES]
                      for what, variant in variants.items()}
            first = next(iter(values.values()))
            for what, mine in values.items():
                if not any(mine):
                    continue
                cells = []
                for least, value in zip(first, mine):
                    ratio = least / value if least and value and mine is not first else None
                    cases += [(what, ratio)] if ratio else []
                    cells.append("–" if not value else text(value) + (f" ({ratio:.2f})" if ratio else ""))
                lines.append([name, side, what] + cells)
    head = ["machine", "on", "traversal"] + [f"{scene}, {phase}" for scene in scenes for _, phase in PHASES]
    return (table(head, lines) if lines else ""), cases


def ahead(cases, what):
    """In how many cases the front is below another traversal."""
    ratios = [ratio for name, ratio in cases if name == what]
    return f"{sum(ratio < 1 for ratio in ratios)} of {len(ratios)} cases" if ratios else "no case, of none"


def climbing_steps(machines):
    """Every eighth step the front climbs: what it tests then, and in the others, over a full traversal's tests."""
    climbing, others = [], []
    for _, rows in machines:
        for scene in in_order(select(rows, part="traversal"), "model"):
            for _, variants in SIDES:
                tests = {row["step"]: row["volume_tests"] for row in select(
                    rows, part="traversal", model=scene, variant=variants[FULL]) if "volume_tests" in row}
                ratios = [(row["step"], row["volume_tests"] / tests[row["step"]]) for row in select(
                    rows, part="traversal", model=scene, variant=variants[FRONT])
                    if row["step"] > 0 and row["step"] in tests and "volume_tests" in row]
                if len(ratios) < 16:
                    continue
                turn = max(range(8), key=lambda eighth: sum(ratio for step, ratio in ratios if step % 8 == eighth))
                climbing += [ratio for step, ratio in ratios if step % 8 == turn]
                others += [ratio for step, ratio in ratios if step % 8 != turn]
    return climbing, others


def front(machines, table, figure):
    tests, cases = traversal_table(machines, SIDES, lambda steps: mean(steps, "volume_tests"), lambda value: f"{value:,.0f}", table)
    if not tests:
        return ""
    text = "Volume tests a step; in brackets what the front tests of it:\n\n" + tests
    climbing, others = climbing_steps(machines)
    text += f"The front tests fewer volumes than the same without it in {ahead(cases, FULL)}, than the simple traversal in {ahead(cases, SIMPLE)}. "
    if climbing:
        text += (f"Every eighth step, in which pairs that came apart climb, it tests {in_words(min(climbing), max(climbing))} of "
                 f"what the same without it does, else {in_words(min(others), max(others))}.")
    times, cases = traversal_table(machines, SIDES, lambda steps: mean(steps, "broad_ms"), figure, table)
    text += ("\n\nBroad phase, ms (kernel time on a device); in brackets what the front takes of it:\n\n" + times
             + f"It takes less time than the same without it in {ahead(cases, FULL)}, than the simple traversal in {ahead(cases, SIMPLE)}.\n\n")
    whole, _ = traversal_table(machines, WHOLE, all_stages, figure, table)
    return text + ("Refit, broad phase, narrow phase and order, ms, likewise; in brackets what the first takes of it:\n\n" + whole)


def times_of(rows, part, variant, column):
    return {row["model"]: row[column] for row in select(rows, part=part, variant=variant) if column in row}


def kernels_of(rows, part, variant):
    return times_of(rows, part, variant, "kernel_median_ms")


def speedup(before, after):
    """How many times as fast, over the models, and on the largest."""
    models = [model for model in after if model in before]
    if not models:
        return "–"
    ratios = [before[model] / after[model] for model in models]
    return f"{in_words(min(ratios), max(ratios))}; {models[-1].replace('_', ' ')} {ratios[-1]:.2f}"


def thesis_speedup(before, after):
    """Of thesis.csv: (table, what) each."""
    ratios = [thesis(*before)[model] / thesis(*after)[model] for model in THESIS_MODELS.values()]
    return in_words(min(ratios), max(ratios), 1)


def broad_speedup(rows, before, after):
    ratios = []
    for scene in in_order(select(rows, part="traversal"), "model"):
        for phase, _ in PHASES:
            times = [mean(descent_steps(rows, scene, variant, phase), "broad_ms") for variant in (before, after)]
            ratios += [times[0] / times[1]] if all(times) else []
    return in_words(min(ratios), max(ratios)) if ratios else "–"


def most_pairs(rows, backend, variant):
    return max((row for row in select(rows, part="triangle_tests", backend=backend, variant=variant) if "median_ms" in row),
               key=lambda row: row["pairs"], default=None)


def narrow_speedup(rows):
    host, device = (most_pairs(rows, backend, "Möller") for backend in ("host", "opencl"))
    return f"{host['median_ms'] / device['kernel_median_ms']:.1f}" if host and device else "–"


def compaction_shares(rows):
    mine = sorted(select(rows, part="compaction"), key=lambda row: row["triangles"])
    return f"{100 * mine[0]['share']:.1f} % to {100 * mine[-1]['share']:.1f} %" if mine else "–"


NORMAL, ADAPTIVE, SMALL, ALL = ("thesis: normal", "thesis: adaptive groups", "thesis: and small splits",
                                "thesis: all optimisations")
LEVELS = "thesis: launch per level"


def builds_over(before, after):
    return lambda rows: speedup(kernels_of(rows, "construction", before), kernels_of(rows, "construction", after))


# Stage, how many times as fast what is, what the thesis found, and the same from rows.
FINDINGS = (
    ("construction", "adaptive group sizes over normal", lambda: "1.67 (Happy Buddha: 67 %)", builds_over(NORMAL, ADAPTIVE)),
    ("construction", "small splits over that", lambda: "1.5 to 2", builds_over(ADAPTIVE, SMALL)),
    ("construction", "large nodes over that", lambda: "1.7 (Happy Buddha: 70 %)", builds_over(SMALL, ALL)),
    ("construction", "all of them over normal", lambda: thesis_speedup(("4.2", "quadro_normal"), ("4.2", "quadro_optimised")),
     builds_over(NORMAL, ALL)),
    ("construction", "the device, with all, over one CPU thread", lambda: thesis_speedup(("4.2", "cpu"), ("4.2", "quadro_optimised")),
     lambda rows: speedup(times_of(rows, "construction", "host, top-down", "median_ms"), kernels_of(rows, "construction", ALL))),
    ("construction", "compaction's share, smallest to largest model", lambda: "small, and less of larger models", compaction_shares),
    ("refit", "the device, a launch a level, over one CPU thread", lambda: thesis_speedup(("4.4", "cpu"), ("4.4", "quadro")),
     lambda rows: speedup(times_of(rows, "refit", "host", "median_ms"), kernels_of(rows, "refit", LEVELS))),
    ("refit", "over construction with all optimisations", lambda: "10",
     lambda rows: speedup(kernels_of(rows, "construction", ALL), kernels_of(rows, "refit", LEVELS))),
    ("broad phase", "simple traversal, one group, over one CPU thread", lambda: "25",
     lambda rows: broad_speedup(rows, "host, thesis: simple", "thesis: simple")),
    ("broad phase", "front over simple", lambda: "more than 1 (figure 4.8)",
     lambda rows: broad_speedup(rows, "thesis: simple", "thesis: front")),
    ("narrow phase", "Möller's test, most pairs, over one CPU thread", lambda: "grows with the pairs (figure 4.9)", narrow_speedup),
)


def findings_table(machines, table):
    lines = [[stage, what, found()] + [of_rows(rows) for _, rows in machines] for stage, what, found, of_rows in FINDINGS]
    return ("How many times as fast (kernel time on a device): the least and the most over the models or scenes, then the largest "
            "model.\n\n" + table(["stage", "what", "thesis"] + [name for name, _ in machines], lines))


def ordered(entries):
    """entries: (value, text), the best first."""
    return " < ".join(text for _, text in sorted(entries, key=lambda entry: entry[0]))


def largest(rows, part):
    return max(select(rows, part=part), key=lambda row: row["triangles"], default={}).get("model")


def ranked(rows, part, figure, value_of=lambda row: row.get("kernel_median_ms"), **columns):
    """Variants of a part, on its largest model, by kernel time or another value."""
    mine = [row for row in select(rows, part=part, **columns) if value_of(row) is not None]
    model = largest(mine, part)
    return [(value_of(row), f"{row['variant'].replace('host, ', '')} {figure(value_of(row))}")
            for row in select(mine, model=model)]


def ranked_steps(rows, scene, phase, on_device, figure):
    entries = []
    for variant in in_order(select(rows, part="traversal", model=scene), "variant"):
        value = all_stages(descent_steps(rows, scene, variant, phase))
        if value and variant.startswith("host") != on_device:
            entries.append((value, f"{variant.replace('host, ', '')} {figure(value)}"))
    return entries


def ranked_tests(rows, backend, figure):
    entries = []
    for variant in in_order(select(rows, part="triangle_tests", backend=backend), "variant"):
        row = most_pairs(rows, backend, variant)
        if row:
            entries.append((row.get("kernel_median_ms", row["median_ms"]), f"{variant} {time_text(row, figure)}"))
    return entries


def rankings(rows, figure):
    """(what, the best first) of a machine."""
    yield "construction on the device, largest model, ms", ranked(rows, "construction", figure, backend="opencl")
    yield "construction on the host, 1 thread, largest model, ms", ranked(
        rows, "construction", figure, value_of=lambda row: row.get("median_ms"), backend="host")
    yield "trees, largest model, volume tests of a step", ranked(
        rows, "quality", lambda value: f"{value:,.0f}", value_of=lambda row: row.get("visits"))
    yield "refit on the device, largest model, ms", ranked(rows, "refit", figure, backend="opencl")
    for scene in in_order(select(rows, part="traversal"), "model"):
        for on_device, place in ((True, "on the device"), (False, "on the host")):
            yield f"all stages of a step at rest {place}, {scene}, ms", ranked_steps(rows, scene, "rest", on_device, figure)
    yield "tests of triangle pairs on the device, most pairs, ms (kernel / host to host)", ranked_tests(rows, "opencl", figure)


# Drape's on a device, and the peers' on CPU threads: (column, part's variant, threads).
TREES = {"construction": "balanced", "refit": "subtrees"}
PEERS = (("Embree, Morton, 2 threads", "embree_morton", 2), ("Embree, Morton, 1 thread", "embree_morton", 1), ("FCL, 18-DOP", "fcl", 1))


def peers_table(machines, table, figure):
    """Construction and refit by a device's default, beside the peers'."""
    lines = []
    for name, rows in machines:
        for part, variant in TREES.items():
            for model in ("bunny", "bunny_1m"):
                mine = select(rows, part=part, variant=variant, model=model, backend="opencl")
                if not mine or "median_ms" not in mine[0]:
                    continue
                line = [name, part, model.replace("_", " "), time_text(mine[0], figure)]
                for _, peer, threads in PEERS:
                    theirs = select(rows, part=part, variant=peer, model=model, threads=threads)
                    time = theirs[0].get("median_ms") if theirs else None
                    line.append(f"{figure(time)} ({mine[0]['median_ms'] / time:.2g})" if time else "–")
                lines.append(line)
    return ("Trees of the largest model and the bunny, ms: Drape's on the device (kernel / host to host), and the peers' on the "
            "machine's CPU; in brackets Drape's, host to host, over theirs.\n\n"
            + table(["machine", "stage", "model", "Drape"] + [peer[0] for peer in PEERS], lines)) if lines else ""


def ranking(machines, table, figure):
    lines = [[name, what, ordered(entries)] for name, rows in machines for what, entries in rankings(rows, figure) if entries]
    if not lines:
        return ""
    return (findings_table(machines, table) + peers_table(machines, table, figure) + "The methods of each stage, the best first:\n\n"
            + table(["machine", "what", "from the best to the worst"], lines))
