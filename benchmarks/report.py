#!/usr/bin/env python3
"""Makes a summary and plots of each machine's CSV: report.py CSV… [--out DIR] [--plots DIR]

Writes NAME.md beside NAME.csv or into DIR. With --plots, writes NAME_steps.svg and NAME_errors.svg into DIR, too, which
needs python3-matplotlib. Ends with 1, naming the rows, and writes nothing where one answer has several hashes.
"""
import argparse
import os
import sys

import hashes
import report_errors
from results import count, figure, fit_exponent, in_order, read_csv, select, table

SCENES = {
    "thesis": "2,048 on the bunny", "fine": "131,072 on the bunny", "fine_on_coarse": "131,072 on a sphere of 1,280",
    "many_200": "200 × 512 on the bunny", "static_1m": "2,048 on the bunny in 1.1 M",
    "static_1m_fine": "131,072 on the bunny in 1.1 M", "self_2k": "2,048 on the bunny and itself",
    "self_131k": "131,072 on the bunny and itself", "folded_131k": "131,072, folded, on the bunny and itself",
}
METHODS = {
    "drape": "Drape, OpenCL", "drape_host": "Drape, host",
    "embree_contacts_2": "Embree + narrow phase, 2 threads", "embree_contacts_1": "Embree + narrow phase, 1 thread",
    "embree_pairs_2": "Embree, pairs only, 2 threads", "embree_pairs_1": "Embree, pairs only, 1 thread",
    "fcl_pairs": "FCL, pairs only", "fcl_collide": "FCL, thickness 0",
}
RUNS = {"drape": "Drape, OpenCL", "drape_host": "Drape, host", "automatic": "Drape, automatic",
        "continuous": "Drape, continuous", "discrete": "Drape, discrete",
        "bullet_stock": "Bullet's own, default settings", "stock": "Bullet's own, default settings",
        "bullet_tuned": "Bullet's own, tuned", "tuned": "Bullet's own, tuned"}
# The size that a sweep of bench_step varies, and its label.
SWEEPS = {
    "cloth": (lambda row: row["cloth_triangles"], "cloth triangles, on the bunny"),
    "obstacle": (lambda row: row["obstacle_triangles"], "sphere triangles, under 2,048 of cloth"),
    "both": (lambda row: row["cloth_triangles"] + row["obstacle_triangles"], "triangles of cloth and sphere"),
    "on_1k": (lambda row: row["cloth_triangles"], "cloth triangles, on a sphere of 1,280"),
    "on_82k": (lambda row: row["cloth_triangles"], "cloth triangles, on a sphere of 81,920"),
    "on_1m": (lambda row: row["cloth_triangles"], "cloth triangles, on a sphere of 1,310,720"),
    "cloths": (lambda row: row["cloth_triangles"], "triangles of cloths of 512, on the bunny"),
}


def first(rows, **wanted):
    return next(iter(select(rows, **wanted)), {})


def time_text(row):
    """Returns median (95th percentile)."""
    return f"{figure(row['median_ms'])} ({figure(row['p95_ms'])})" if "median_ms" in row else "–"


def step_table(rows):
    rows = [row for row in select(rows, stage="step") if not row.get("setting")]
    scenes = [scene for scene in SCENES if select(rows, scene=scene)]
    if not scenes:
        return ""
    lines = [[label] + [time_text(first(rows, scene=scene, method=method)) for scene in scenes]
             for method, label in METHODS.items() if select(rows, method=method)]
    # Contacts are the same on every back end; candidates are not.
    for label, column, methods in (("candidates of the host", "candidates", ("drape_host",)),
                                   ("contacts", "contacts", ("drape_host", "drape"))):
        counts = [[row[column] for method in methods for row in select(rows, scene=scene, method=method)]
                  for scene in scenes]
        lines.append([label] + [count(found[0] if found else None) for found in counts])
    lines.append(["device memory, MiB"] + [figure(first(rows, scene=scene, method="drape").get("bytes", 0) / 2 ** 20)
                                           for scene in scenes])
    return ("## Whole steps\n\nHost to host, ms: median (95th percentile).\n\n"
            + table(["cloth triangles"] + [SCENES[scene] for scene in scenes], lines))


def stage_table(rows):
    lines = []
    for scene, label in SCENES.items():
        mine = select(rows, scene=scene, method="drape_kernels")
        if mine:
            lines.append([label] + [figure(first(mine, stage=stage).get("median_ms"))
                                    for stage in ("broad", "self", "narrow", "order", "kernels")])
    return ("Kernel time of a step on the device, ms, medians with a profiled queue:\n\n"
            + table(["scene", "broad phase", "cloth with itself", "narrow phase", "order", "sum"],
                    lines)) if lines else ""


def growth_table(rows):
    lines = []
    for sweep, (size, label) in SWEEPS.items():
        mine = select(rows, setting=sweep, stage="step")
        for method in ("drape", "drape_host", "embree_pairs_2"):
            points = [(size(row), row["median_ms"]) for row in select(mine, method=method) if "median_ms" in row]
            grows = fit_exponent(points)
            if len(points) > 2 and grows is not None:
                lines.append([label, METHODS[method], f"{figure(points[0][1])} to {figure(points[-1][1])}",
                              f"{grows:.2f}"])
    return ("Growth of a step's time over the sweeps, ms from the smallest to the largest size, and the exponent p of the fit "
            "time ~ sizeᵖ:\n\n" + table(["size", "method", "ms", "p"], lines)) if lines else ""


def drop_table(rows):
    if not rows:
        return ""
    lines = []
    for row in select(rows, stage="collision"):
        setting = row.get("setting", "")
        finding = next((other for other in select(rows, stage="finding", method=row["method"], device=row["device"])
                        if other.get("setting", "") == setting), {})
        capped = f", ended after {row['steps']:.0f} steps" * (row["ended"] == "capped")
        lines.append([RUNS[row["method"]] + f", {setting}" * bool(setting), row["device"] + capped, time_text(row),
                      figure(finding.get("median_ms")), figure(row["penetration_mm"]),
                      count(row.get("intersecting_pairs")),
                      count(row.get("nodes_through")), f"`{row['hash']}`"])
    return ("## A cloth dropped on the bunny\n\n2,048 triangles of cloth, 240 steps (`cloth_drop.sh`). Times are medians "
            "(95th percentiles) of the steps in contact. Bullet's times include finding contacts alone; its "
            "solver takes them afterwards.\n\n"
            + table(["", "on", "collision, ms", "finding contacts, ms", "deepest penetration, mm",
                     "intersecting pairs, end",
                     "nodes through", "hash"], lines))


def speed_table(rows):
    speeds = in_order(rows, "setting")
    if not speeds:
        return ""

    def text(row):
        if "penetration_mm" not in row:
            return "–"
        capped = f", {row['steps']:.0f} steps" * (row["ended"] == "capped")
        return (f"{count(row.get('intersecting_pairs'))} / {count(row.get('nodes_through'))} / {count(row['penetration_mm'])}"
                + ", no contact" * (not row["contacts"]) + capped)

    lines = [[RUNS[run]] + [text(first(rows, method=run, setting=speed)) for speed in speeds]
             for run in in_order(rows, "method")]
    return ("## A cloth thrown at the bunny\n\n100 steps (`drop_speeds.sh`): most intersecting pairs after any step / "
            "nodes through the surface / deepest penetration in mm. Runs with fewer steps met the time limit.\n\n"
            + table([""] + speeds, lines))


def check_table(rows):
    lines = [[f"{row['scene']} {row.get('setting', '')}".strip(), row["device"],
              count(row.get("queries", row.get("candidates"))),
              count(row.get("misses")), count(row.get("false_hits")), count(row.get("contacts")),
              figure(row["median_ms"]) if row["median_ms"] >= 1 else f"{row['median_ms']:.3g}"] for row in rows]
    return ("## Published queries with exact answers\n\n`drape_check.sh`. Of `ccd` and `triangles` the time is that of one query. "
            "`pairs` counts intersecting triangles of the cloth-ball scene, `step` its edge-edge pairs.\n\n"
            + table(["question", "on", "queries or candidates", "misses", "false hits", "found", "ms"],
                    lines)) if lines else ""


def summary(name, rows):
    commits = ", ".join(f"{program} {'/'.join(in_order(select(rows, program=program), 'commit'))}"
                        for program in in_order(rows, "program"))
    devices = ", ".join(device for device in in_order(rows, "device") if device != "host") or "none"
    text = (f"# {name}\n\n{rows[0]['machine']}; OpenCL device: {devices}. Commits: {commits}.\n\n"
            f"`report.py` makes this page from [{name}.csv]({name}.csv).\n\n")
    of = {program: select(rows, program=program)
          for program in ("bench_step", "cloth_drop", "drop_speeds", "drape_check",
                                                                 "error_vs_time", "queries")}
    text += step_table(of["bench_step"]) + stage_table(of["bench_step"]) + growth_table(of["bench_step"])
    text += drop_table(of["cloth_drop"]) + speed_table(of["drop_speeds"]) + report_errors.text(of["error_vs_time"])
    return (text + report_errors.query_table(of["queries"]) + check_table(of["drape_check"])).rstrip("\n") + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("csv", nargs="+")
    parser.add_argument("--out", help="folder of the summaries")
    parser.add_argument("--plots", help="folder of the plots")
    arguments = parser.parse_args()
    machines = [(os.path.basename(path)[:-4], read_csv(path)) for path in arguments.csv]
    different = hashes.differences(machines)
    if different:
        sys.exit("\n".join(different))
    for path, (name, rows) in zip(arguments.csv, machines):
        out = arguments.out or os.path.dirname(path) or "."
        os.makedirs(out, exist_ok=True)
        with open(os.path.join(out, name + ".md"), "w") as file:
            file.write(summary(name, rows))
        if arguments.plots:
            import report_plots  # needs matplotlib, which the tables do without
            os.makedirs(arguments.plots, exist_ok=True)
            report_plots.draw(os.path.join(arguments.plots, name), rows, SWEEPS, METHODS)


if __name__ == "__main__":
    main()
