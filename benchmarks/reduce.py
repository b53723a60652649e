#!/usr/bin/env python3
"""Reduces a folder of raw results to a machine's small CSV: reduce.py RAW_DIR CSV

RAW_DIR holds JSON files of bench_step, error_vs_time, cloth_drop, drop_speeds and drape_check; a file's name starts
with its program's. The CSV keeps the rows that report.py uses. New rows replace old rows of the same program, scene,
setting and method; other old rows stay, so that a machine can be measured in parts. Void rows are named and left out.
Ends with 3 when a row is void, with 2 when the CSV is of another machine.
"""
import sys

import hashes
from results import raw_rows, update_csv

COLUMNS = ("machine", "commit", "program", "scene", "setting", "method", "stage", "device", "threads",
           "cloth_triangles", "obstacle_triangles", "steps", "min_ms", "median_ms", "p95_ms", "candidates", "contacts",
           "bytes", "penetration_mm", "intersecting_pairs", "nodes_through", "speed_mm_s", "energy_gain", "shape_error",
           "queries", "misses", "false_hits", "ended", "hash")
GROUP = ("program", "scene", "setting", "method")
# The stages of a step that a profiled queue tells apart; "kernels" is their sum.
STAGES = ("refit", "broad", "self", "narrow", "order", "kernels")
SWEEP_METHODS = ("drape", "drape_host", "embree_contacts_2", "embree_pairs_2", "fcl_pairs")


def times(row, form, factor=1):
    found = {column: row.get(form.format(name))
             for column, name in (("min_ms", "min"), ("median_ms", "median"), ("p95_ms", "p95"))}
    return {column: value * factor for column, value in found.items() if value is not None}


def steps(rows):
    """Yields whole steps, of sweeps by the main methods alone, and outside of sweeps kernel times by stage."""
    memory = {}
    for row, _ in rows:
        if row["stage"].startswith("memory: "):
            key = row["scene"], row["method"]
            memory[key] = memory.get(key, 0) + row["bytes"]
    for row, _ in rows:
        profiled = row["method"].endswith("_kernels")
        if row["stage"] not in (STAGES if profiled else ("step",)):
            continue
        if row["sweep"] and row["method"] not in SWEEP_METHODS:
            continue
        yield {**row, "setting": row["sweep"], "bytes": None if profiled else memory.get((row["scene"], row["method"]))}


def errors(rows):
    """Yields simulations of error_vs_time, and its queries with the default settings or another test."""
    for row, _ in rows:
        value = f"{row['value']:.3g}" if row["value"] else ""
        common = {**row, "setting": f"{row['knob']} {row['setting'] or value}".strip(), "value": None}
        if row["knob"] == "rest" and row["value"]:
            common["setting"] += f" {value}" if row["setting"] else ""
        if row["part"] == "detector":
            if row["knob"] in ("defaults", "test"):
                yield {**common, "program": "queries", **times(row, "query_{}_us", 0.001)}
            continue
        depth = row.get("penetration_max")
        yield {**common, **times(row, "frame_{}_ms"), "steps": row.get("frames"), "contacts": row.get("contacts_max"),
               "penetration_mm": None if depth is None else 1000 * depth * row["thickness_m"],
               "intersecting_pairs": row.get("intersecting_max"),
               "speed_mm_s": row.get("rest_speed_mm_s", row.get("late_speed_mm_s"))}


def worlds(rows):
    """Yields runs of cloth_drop and drop_speeds. The stage "finding" is the part of a collision that finds contacts."""
    for row, content in rows:
        scene = content["scene"]
        speed = f"{row['speed_m_s']:g} m/s" if "speed_m_s" in row else ""
        capped = "capped_at_step" in row or row.get("ended", "whole") != "whole"
        depth = row["penetration_max_m"]
        common = {**row, "scene": f"{scene['obstacle']} {scene['obstacle_digest']}",
                  "setting": " ".join(filter(None, (speed, *hashes.settings_of(scene["options"])))),
                  "method": "drape_host" if row["run"] == "drape" and row["device"] == "host" else row["run"],
                  "contacts": row["contacts_max"], "ended": "capped" if capped else "whole",
                  "penetration_mm": None if depth is None else 1000 * depth,
                  "intersecting_pairs": row.get("intersecting_pairs_max", row.get("intersecting_pairs_end"))}
        if speed:
            yield common
            continue
        for stage in ("collision", "finding"):
            yield {**common, "stage": stage, **times(row.get(stage + "_ms") or {}, "{}")}


def checks(rows):
    for row, _ in rows:
        yield {**row, "method": "drape_host" if row["backend"] == "host" else "drape", "scene": row["question"],
               "setting": row.get("mode", ""), "median_ms": row["ms"] if "ms" in row else row["us_per_query"] / 1000,
               "candidates": row.get("candidates", row.get("ee_candidates")),
               "contacts": row.get("intersecting_pairs", row.get("ee_hits")), "intersecting_pairs": None}


PROGRAMS = {"bench_step": steps, "error_vs_time": errors, "cloth_drop": worlds, "drop_speeds": worlds,
            "drape_check": checks}


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    reduced = [{"program": program, **row} for program, rows_of in PROGRAMS.items()
               for row in rows_of(raw_rows(sys.argv[1], program))]
    if not reduced:
        sys.exit(f"reduce.py: no results in {sys.argv[1]}")
    sys.exit(update_csv(sys.argv[2], COLUMNS, GROUP, reduced))


if __name__ == "__main__":
    main()
