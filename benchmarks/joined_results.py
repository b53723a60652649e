"""Joins files of results, {"machine": …, "rows": […]}, into one: what merge_study.py and merge_errors.py share."""
import csv
import json
import os
import sys


def place(text, order):
    return order.index(text) if text in order else len(order)


def machine_key(machine):
    devices = sorted((device["device"], device.get("driver", "")) for device in machine["devices"])
    return machine["processor"], machine["cores"], devices


def merge(files, completed, joined):
    """files: (name, content). completed(row, name): the row, or ValueError. joined(old rows, new rows): what stays of both.
    Returns machine and rows, each with the commit that it was measured at; the machine's date is the last run's, its commits
    are the rows'."""
    machine, rows = None, []
    for name, content in files:
        if machine and machine_key(content["machine"]) != machine_key(machine):
            raise ValueError(f"{name}: of another machine than {files[0][0]}")
        machine = dict(content["machine"])
        rows = joined(rows, [{**completed(row, name), "commit": row.get("commit", machine["commit"])} for row in content["rows"]])
    machine["commit"] = ", ".join(dict.fromkeys(row["commit"] for row in rows))
    return machine, rows


def cell(value):
    return f"{value:.6g}" if isinstance(value, float) else value


def write(folder, result, machine, rows):
    columns = list(dict.fromkeys(name for row in rows for name in row))
    path = os.path.join(folder, result)
    with open(path + ".json.part", "w") as file:
        json.dump({"machine": machine, "rows": rows}, file, indent=1, ensure_ascii=False)
        file.write("\n")
    with open(path + ".csv", "w", newline="") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows({name: cell(value) for name, value in row.items()} for row in rows)
    # Last, and at once: what is there is always whole.
    os.replace(path + ".json.part", path + ".json")


def main(usage, result, merge_files):
    """The program of a merge: merge_files(files) gives machine and rows; `result` is the name of the files in OUT_DIR."""
    if len(sys.argv) < 3:
        sys.exit(usage)
    folder, names = sys.argv[1], sys.argv[2:]
    before = os.path.join(folder, result + ".json")
    if os.path.exists(before) and not any(os.path.samefile(before, name) for name in names if os.path.exists(name)):
        names.insert(0, before)
    try:
        files = []
        for name in names:
            with open(name) as file:
                files.append((name, json.load(file)))
        machine, rows = merge_files(files)
    except (OSError, ValueError, KeyError) as problem:
        print(f"{os.path.basename(sys.argv[0])}: {problem}", file=sys.stderr)
        sys.exit(2)
    os.makedirs(folder, exist_ok=True)
    write(folder, result, machine, rows)
    sys.exit(3 if any(row.get("valid") == "no" for row in rows) else 0)
