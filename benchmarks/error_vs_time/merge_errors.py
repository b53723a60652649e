#!/usr/bin/env python3
"""Joins results of error_vs_time: merge_errors.py OUT_DIR ERROR_VS_TIME_JSON…

Writes OUT_DIR/error_vs_time.json and .csv with the rows of all files; OUT_DIR/error_vs_time.json itself, where it is there,
comes first. Of the rows of one trial or query (part, scene, method, knob, value and setting) the last stays, but one that
was not run never takes the place of one that was. Each keeps the commit that it was measured at. Rows of
one commit are judged together, whichever file they came from: one that must have the hash of the host's (column must_match)
and has another is void. All must be of one machine: same processor, cores and devices. Ends with 3 when a row is void, with 2
when files cannot be read, lack what names a row, or are of different machines.
"""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import joined_results
from joined_results import place

KEY = ("part", "scene", "method", "knob", "value", "setting")
PARTS = ("detector", "simulation")
SCENES = ("bunny", "stairs", "plate", "pile", "dragon")
# How much a row says that was not measured; every other says more.
NOT_RUN = ("no time", "left out")
# What a void row may keep of its numbers: what it was.
INPUTS = ("value", "thickness_m", "activation", "substeps", "iterations", "voxel_m", "seed")


def key_of(row):
    return tuple(row[column] for column in KEY)


def complete(row, name):
    for column in KEY:
        if column not in row:
            raise ValueError(f"{name}: a row of {row.get('part')}, {row.get('scene')} has no {column}")
    return row


def joined(old, new):
    """In the order of first measurement: a row takes the place of what it replaces."""
    rows = {key_of(row): row for row in old}
    for row in new:
        before = rows.get(key_of(row), row)
        if place(row["ended"], NOT_RUN) >= place(before["ended"], NOT_RUN):
            rows[key_of(row)] = row
    return list(rows.values())


def host_key(row):
    """The key of the row whose hash this one must have; None where it may have any."""
    match = row.get("must_match")
    if match == "defaults":
        return row["part"], row["scene"], "drape_host", "defaults", 0, ""
    return tuple("drape_host" if column == "method" else row[column] for column in KEY) if match == "same" else None


def judged(row, rows):
    """rows: all by their keys. A row that was void stays so: its figures are gone."""
    host = rows.get(host_key(row), {})
    if not row.get("hash") or not host.get("hash") or host["commit"] != row["commit"] or row.get("valid") == "no":
        return row
    if row["hash"] == host["hash"]:
        return {**row, "valid": "yes"}
    return {**{name: value for name, value in row.items() if name in INPUTS or not isinstance(value, (int, float))}, "valid": "no"}


def merge(files):
    machine, rows = joined_results.merge(files, complete, joined)
    by_key = {key_of(row): row for row in rows}
    rows = [judged(row, by_key) for row in rows]
    # Sets of queries as they came.
    return machine, sorted(rows, key=lambda row: (place(row["part"], PARTS), place(row["scene"], SCENES)))


if __name__ == "__main__":
    joined_results.main(__doc__, "error_vs_time", merge)
