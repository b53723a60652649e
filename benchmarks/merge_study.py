#!/usr/bin/env python3
"""Joins results of the study: merge_study.py OUT_DIR STUDY_JSON…

Writes OUT_DIR/study.json and study.csv with the rows of all files; OUT_DIR/study.json itself, where it is there, comes
first. Of rows with the same part, model, back end and volumes those of the last file stay, so that a part that was
measured again replaces what it was. Every row must say its back end and carry a hash; it keeps the commit that it was
measured at. All must be of one machine: same processor, cores and devices. Ends with 3 when a row is void, with 2 when files
cannot be read, lack a back end or a hash, or are of different machines.
"""
import csv
import json
import os
import sys

PARTS = ("construction", "construction_kernels", "compaction", "levels", "refit", "refit_kernels", "refit_levels", "quality", "shape", "degree",
         "traversal", "builder", "rebuild", "triangle_tests")
BACKENDS = ("embree", "fcl", "host", "opencl")
INPUTS = ("triangles", "cloth_triangles")


def place(text, order):
    return order.index(text) if text in order else len(order)


def key_of(row):
    """Rows of one key were measured together."""
    return row.get("part"), row.get("model"), row.get("backend"), row.get("dop")


def sort_key(row):
    return (place(row.get("part"), PARTS), *(row.get(name, 0) for name in INPUTS), row.get("dop", 0),
            place(row.get("backend"), BACKENDS))


def machine_key(machine):
    devices = sorted((device["device"], device.get("driver", "")) for device in machine["devices"])
    return machine["processor"], machine["cores"], devices


def complete(row, commit, name):
    """The row with its commit. One without a back end would never be replaced, and one without a hash cannot be judged."""
    for column in ("backend", "hash"):
        if not row.get(column):
            raise ValueError(f"{name}: a row of {row.get('part')}, {row.get('model')} has no {column}")
    return {**row, "commit": row.get("commit", commit)}


def merge(files):
    """files: (name, content). Returns machine and rows; the machine's date is the last run's, its commits are the rows'."""
    machine, rows = None, []
    for name, content in files:
        if machine and machine_key(content["machine"]) != machine_key(machine):
            raise ValueError(f"{name}: of another machine than {files[0][0]}")
        machine = dict(content["machine"])
        new = [complete(row, machine["commit"], name) for row in content["rows"]]
        again = {key_of(row) for row in new}
        rows = [row for row in rows if key_of(row) not in again] + new
    machine["commit"] = ", ".join(dict.fromkeys(row["commit"] for row in rows))
    return machine, sorted(rows, key=sort_key)


def cell(value):
    return f"{value:.6g}" if isinstance(value, float) else value


def write(folder, machine, rows):
    columns = list(dict.fromkeys(name for row in rows for name in row))
    with open(os.path.join(folder, "study.json.part"), "w") as file:
        json.dump({"machine": machine, "rows": rows}, file, indent=1, ensure_ascii=False)
        file.write("\n")
    with open(os.path.join(folder, "study.csv"), "w", newline="") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows({name: cell(value) for name, value in row.items()} for row in rows)
    # Last, and at once: what is there is always whole.
    os.replace(os.path.join(folder, "study.json.part"), os.path.join(folder, "study.json"))


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    folder, names = sys.argv[1], sys.argv[2:]
    before = os.path.join(folder, "study.json")
    if os.path.exists(before) and not any(os.path.samefile(before, name) for name in names if os.path.exists(name)):
        names.insert(0, before)
    try:
        files = []
        for name in names:
            with open(name) as file:
                files.append((name, json.load(file)))
        machine, rows = merge(files)
    except (OSError, ValueError, KeyError) as problem:
        print(f"merge_study.py: {problem}", file=sys.stderr)
        sys.exit(2)
    os.makedirs(folder, exist_ok=True)
    write(folder, machine, rows)
    sys.exit(3 if any(row.get("valid") == "no" for row in rows) else 0)


if __name__ == "__main__":
    main()
