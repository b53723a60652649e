"""Reads what the benchmark programs wrote. Void rows are left out: no figure of a wrong result is ever shown."""
import csv
import json
import math
import os


def read_rows(folder, name):
    """Rows of FOLDER/NAME.csv as dictionaries, numbers as floats, empty cells left out. Empty without the file."""
    path = os.path.join(folder, name + ".csv")
    if not os.path.exists(path):
        return []
    with open(path, newline="") as file:
        return [number_cells(row) for row in csv.DictReader(file) if row.get("valid") != "no"]


def read_steps(folder):
    """Rows of bench_step, and of what it left to the run that was its --reference (bench_step_reference.csv): scenes'
    methods without a row of their own."""
    rows = read_rows(folder, "bench_step")
    measured = {(row["scene"], row["method"]) for row in rows}
    scenes = {row["scene"] for row in rows}
    return rows + [row for row in read_rows(folder, "bench_step_reference")
                   if row["scene"] in scenes and (row["scene"], row["method"]) not in measured]


def count_void(folder, name):
    path = os.path.join(folder, name + ".csv")
    if not os.path.exists(path):
        return 0
    with open(path, newline="") as file:
        return sum(row.get("valid") == "no" for row in csv.DictReader(file))


def number_cells(row):
    texts = ("hash", "commit", "driver", "device", "variant")
    cells = {}
    for name, text in row.items():
        if not text:
            continue
        try:
            cells[name] = text if name in texts else float(text)
        except ValueError:
            cells[name] = text
    return cells


def read_machine(folder, name):
    with open(os.path.join(folder, name + ".json")) as file:
        return json.load(file)["machine"]


def read_json(folder, name):
    path = os.path.join(folder, name + ".json")
    if not os.path.exists(path):
        return None
    with open(path) as file:
        return json.load(file)


def select(rows, **wanted):
    return [row for row in rows if all(row.get(key) == value for key, value in wanted.items())]


def in_order(rows, key):
    """The values of a column in the order of first use."""
    return list(dict.fromkeys(row[key] for row in rows if key in row))


def fit_exponent(points):
    """p of the least-squares fit y = c x^p in logarithms; None with fewer than two different x."""
    logs = [(math.log(x), math.log(y)) for x, y in points if x > 0 and y > 0]
    if len({x for x, _ in logs}) < 2:
        return None
    mean_x = sum(x for x, _ in logs) / len(logs)
    mean_y = sum(y for _, y in logs) / len(logs)
    spread = sum((x - mean_x) ** 2 for x, _ in logs)
    return sum((x - mean_x) * (y - mean_y) for x, y in logs) / spread


def n_log_n_exponent(sizes):
    """What fit_exponent() gives for times of n log n at these sizes."""
    return fit_exponent([(size, size * math.log(size)) for size in sizes if size > 1])


# The size that a sweep of bench_step varies, and how it is called.
SWEEPS = {
    "cloth": (lambda row: row["cloth_triangles"], "cloth triangles, on the bunny"),
    "obstacle": (lambda row: row["obstacle_triangles"], "obstacle triangles (spheres) under 2,048 of cloth"),
    "both": (lambda row: row["cloth_triangles"] + row["obstacle_triangles"], "triangles of cloth and sphere together"),
    "on_1k": (lambda row: row["cloth_triangles"], "cloth triangles, on a sphere of 1,280"),
    "on_82k": (lambda row: row["cloth_triangles"], "cloth triangles, on a sphere of 81,920"),
    "on_1m": (lambda row: row["cloth_triangles"], "cloth triangles, on a sphere of 1,310,720"),
    "cloths": (lambda row: row["cloths"], "cloths of 512 triangles, on the bunny"),
}

# The stages of a step; on a device, the sums of their kernels' times.
STAGES = ("refit", "broad", "self", "narrow", "order")
