"""Results of the benchmarks: raw JSON files as programs write them, and the small CSV of a machine."""
import csv
import json
import math
import os


def raw_rows(folder, program):
    """Returns (row, content of its file) for every row of files PROGRAM*.json. Rows have their commit and machine."""
    found = []
    for name in sorted(os.listdir(folder)):
        if name.startswith(program) and name.endswith(".json"):
            with open(os.path.join(folder, name)) as file:
                content = json.load(file)
            machine = content["machine"]
            common = {"commit": machine["commit"], "machine": f"{machine['processor']}, {machine['cores']:.0f} cores"}
            found += [({**common, **row}, content) for row in content["rows"]]
    return found


# Columns that hold text even where it looks like a number.
TEXTS = ("hash", "commit", "device", "variant", "setting", "machine", "method", "stage")


def number(text):
    try:
        return float(text)
    except ValueError:
        return text


def read_csv(path):
    """Returns rows as dictionaries. Numbers are floats; empty cells are left out."""
    with open(path, newline="") as file:
        return [{name: text if name in TEXTS else number(text) for name, text in row.items() if text}
                for row in csv.DictReader(file)]


def cell(value):
    if not isinstance(value, float):
        return value
    return f"{value:.5g}" if abs(value) < 1e5 else f"{value:.0f}"


def update_csv(path, columns, group, rows):
    """Adds rows to a machine's CSV. They replace all old rows with the same values in the columns of `group`.

    Names void rows and leaves them out. Returns the exit code: 0, 3 with void rows, 2 for another machine's file.
    """
    void = [row for row in rows if row.get("valid") == "no"]
    for row in void:
        print("void:", ", ".join(str(row.get(name, "")) for name in group))
    rows = [row for row in rows if row.get("valid") != "no"]
    old = read_csv(path) if os.path.exists(path) else []
    machines = {row["machine"] for row in old + rows}
    if len(machines) > 1:
        print(f"{path}: results of several machines: {'; '.join(sorted(machines))}")
        return 2

    def key(row):
        return tuple(str(cell(float(value)) if isinstance(value, (int, float)) else value or "")
                     for value in map(row.get, group))

    anew = {key(row) for row in rows}
    with open(path + ".part", "w", newline="") as file:
        writer = csv.DictWriter(file, columns, restval="", extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        writer.writerows({name: cell(value) for name, value in row.items()}
                         for row in [row for row in old if key(row) not in anew] + rows)
    os.replace(path + ".part", path)
    return 3 if void else 0


def select(rows, **wanted):
    return [row for row in rows if all(row.get(key) == value for key, value in wanted.items())]


def in_order(rows, key):
    """Returns the values of a column in the order of their first use."""
    return list(dict.fromkeys(row[key] for row in rows if key in row))


def figure(value):
    """Returns a number with three digits and no exponent."""
    if value is None:
        return "–"
    digits = 0 if value >= 100 or value == 0 else 1 if value >= 10 else 2 if value >= 1 else 3
    return f"{value:,.{digits}f}"


def count(value):
    return "–" if value is None else f"{value:,.0f}"


def table(head, lines):
    return "".join("| " + " | ".join(line) + " |\n" for line in [head, ["---"] * len(head), *lines]) + "\n"


def fit_exponent(points):
    """Returns p of the least-squares fit y = c x^p in logarithms; None with fewer than two different x."""
    logs = [(math.log(x), math.log(y)) for x, y in points if x > 0 and y > 0]
    if len({x for x, _ in logs}) < 2:
        return None
    mean_x = sum(x for x, _ in logs) / len(logs)
    mean_y = sum(y for _, y in logs) / len(logs)
    spread = sum((x - mean_x) ** 2 for x, _ in logs)
    return sum((x - mean_x) * (y - mean_y) for x, y in logs) / spread
