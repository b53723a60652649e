#!/usr/bin/env python3
"""Reduces a folder of the study's raw results to a machine's small CSV: reduce.py RAW_DIR CSV

RAW_DIR holds the files study*.json that run.sh writes. The CSV keeps the rows that report.py uses; steps of a traversal
become their mean. New rows replace old rows of the same part, model, back end and number of sides. Void rows are named
and left out. Ends with 3 when a row is void, with 2 when the CSV is of another machine.
"""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "benchmarks"))
from results import raw_rows, update_csv

COLUMNS = ("machine", "commit", "part", "model", "variant", "phase", "level", "stage", "backend", "device", "threads",
           "triangles", "dop", "min_ms", "median_ms", "p95_ms", "kernel_ms", "refit_ms", "broad_ms", "narrow_ms",
           "order_ms", "volume_tests", "candidates", "contacts", "bytes", "pairs", "share", "hash")
GROUP = ("part", "model", "backend", "dop")
# Parts that vary the trees are reported on these alone.
FEW_MODELS = ("bunny", "bunny_1m", "thesis", "fine", "sphere_1k", "quick_one")
MEANS = ("refit_ms", "broad_ms", "narrow_ms", "order_ms", "volume_tests", "candidates", "contacts")


def mean(rows, column):
    found = [row[column] for row in rows if row.get(column) is not None]
    return sum(found) / len(found) or None if found else None


def steps(rows):
    """Yields one row for each model, variant and phase: the mean of its steps. The first step of a pass follows the last
    one of the pass before, so it is left out; its hash stands for none."""
    groups = {}
    for row in rows:
        if row["step"] > 0 and "broad_ms" in row:
            groups.setdefault((row["model"], row["variant"], row.get("phase", "descent")), []).append(row)
    for (_, _, phase), mine in groups.items():
        yield {**mine[-1], "phase": phase, "median_ms": mean(mine, "step_ms"),
               **{column: mean(mine, column) for column in MEANS}}


def sides(rows):
    """Yields one row for each stage of a tree or step in volumes of other sides."""
    for row in rows:
        for stage in ("build", "refit", "walk", "step"):
            if f"{stage}_median_ms" in row:
                times = {f"{name}_ms": row.get(f"{stage}_{name}_ms") for name in ("min", "median", "p95")}
                yield {**row, **times, "stage": stage, "kernel_ms": row.get(f"{stage}_kernel_median_ms")}


def reduced(rows):
    of = {}
    for row in rows:
        if row.get("valid") == "no":
            yield row  # update_csv names it
            continue
        of.setdefault(row["part"], []).append({**row, "kernel_ms": row.get("kernel_median_ms"), "volume_tests": row.get(
            "volume_tests", row.get("visits"))})
    largest = max((row["triangles"] for row in of.get("levels", []) + of.get("refit_levels", [])), default=0)
    for part, mine in of.items():
        if part in ("traversal", "builder"):
            yield from steps(mine)
        elif part == "degree":
            yield from sides(row for row in mine if row["model"] in FEW_MODELS)
        elif part in ("shape", "obstacles"):
            yield from (row for row in mine if row["model"] in FEW_MODELS)
        elif part in ("levels", "refit_levels"):
            yield from (row for row in mine if row["triangles"] == largest)
        elif part in ("construction", "refit", "quality", "compaction", "triangle_tests"):
            yield from mine


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    rows = [row for row, _ in raw_rows(sys.argv[1], "study")]
    if not rows:
        sys.exit(f"reduce.py: no study*.json in {sys.argv[1]}")
    sys.exit(update_csv(sys.argv[2], COLUMNS, GROUP, list(reduced(rows))))


if __name__ == "__main__":
    main()
