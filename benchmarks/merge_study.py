#!/usr/bin/env python3
"""Joins results of the study: merge_study.py OUT_DIR STUDY_JSON…

Writes OUT_DIR/study.json and study.csv with the rows of all files; OUT_DIR/study.json itself, where it is there, comes
first. Of rows with the same part, model, back end and volumes those of the last file stay, so that a part that was
measured again replaces what it was. Every row must say its back end and carry a hash; it keeps the commit that it was
measured at. All must be of one machine: same processor, cores and devices. Ends with 3 when a row is void, with 2 when files
cannot be read, lack a back end or a hash, or are of different machines.
"""
import joined_results
from joined_results import place

PARTS = ("construction", "construction_kernels", "compaction", "levels", "refit", "refit_kernels", "refit_levels", "quality", "shape", "degree",
         "traversal", "builder", "rebuild", "obstacles", "triangle_tests")
BACKENDS = ("embree", "fcl", "host", "opencl")
INPUTS = ("triangles", "cloth_triangles")


def key_of(row):
    """Rows of one key were measured together."""
    return row.get("part"), row.get("model"), row.get("backend"), row.get("dop")


def sort_key(row):
    return (place(row.get("part"), PARTS), *(row.get(name, 0) for name in INPUTS), row.get("dop", 0),
            place(row.get("backend"), BACKENDS))


def complete(row, name):
    """One without a back end would never be replaced, and one without a hash cannot be judged."""
    for column in ("backend", "hash"):
        if not row.get(column):
            raise ValueError(f"{name}: a row of {row.get('part')}, {row.get('model')} has no {column}")
    return row


def joined(old, new):
    again = {key_of(row) for row in new}
    return [row for row in old if key_of(row) not in again] + new


def merge(files):
    machine, rows = joined_results.merge(files, complete, joined)
    return machine, sorted(rows, key=sort_key)


if __name__ == "__main__":
    joined_results.main(__doc__, "study", merge)
