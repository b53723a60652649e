#!/usr/bin/env python3
"""Writes the tables of all measured results: summary.py [FOLDER]

FOLDER, this one unless said, has results/ with a folder for each machine. Their tables go into results/README.md, those of
the findings (study_findings.py) into README.md, where it has their markers. What stands outside of the markers is written by
hand. Ends with 1, naming the rows, and writes nothing when results of one commit have several hashes of the same trajectory.
"""
import math
import os
import sys

import hashes
import script_tables
import study_findings
import study_tables
from results import (STAGES, SWEEPS, count_void, fit_exponent, in_order, n_log_n_exponent, read_json, read_machine,
                     read_rows, read_steps, select)

HERE = os.path.dirname(os.path.abspath(__file__))

SCENES = {
    "thesis": "2,048 on the bunny",
    "fine": "131,072 on the bunny",
    "fine_on_coarse": "131,072 on a sphere of 1,280",
    "many_200": "200 × 512 on the bunny",
    "static_1m": "2,048 on the bunny in 1.1 M",
    "static_1m_fine": "131,072 on the bunny in 1.1 M",
    "self_2k": "2,048 on the bunny and itself",
    "self_131k": "131,072 on the bunny and itself",
}
METHODS = {
    "drape": "Drape, OpenCL",
    "drape_reduced": "the same, redundant contacts left out",
    "drape_host": "Drape, host",
    "drape_host_front": "the same by the thesis's front over trees of triangles",
    "drape_host_reduced": "the same, redundant contacts left out",
    "embree_contacts_2": "Embree + narrow phase, 2 threads",
    "embree_contacts_1": "the same, 1 thread",
    "embree_pairs_2": "Embree, pairs only, 2 threads",
    "embree_pairs_1": "the same, 1 thread",
    "fcl_pairs": "FCL, pairs only",
    "fcl_collide": "FCL, thickness 0",
}


def figure(value):
    """Three digits, no exponent."""
    if value is None:
        return "–"
    digits = 0 if value >= 100 else 1 if value >= 10 else 2 if value >= 1 else 3
    return f"{value:,.{digits}f}"


def table(head, lines):
    text = "| " + " | ".join(head) + " |\n|" + "---|" * len(head) + "\n"
    return text + "".join("| " + " | ".join(line) + " |\n" for line in lines) + "\n"


def cell_of(rows, **wanted):
    found = select(rows, **wanted)
    if not found or "median_ms" not in found[0]:
        return "–"
    return f"{figure(found[0]['median_ms'])} ({figure(found[0]['p95_ms'])})"


def step_table(rows):
    scenes = [scene for scene in SCENES if select(rows, scene=scene)]
    if not scenes:
        return ""
    methods = [method for method in METHODS if select(rows, method=method)]
    lines = [[METHODS[method]] + [cell_of(rows, scene=scene, method=method, stage="step") for scene in scenes]
             for method in methods]
    # Contacts are the same on host and device; candidates are not, pairs of triangles and of features.
    for label, what, sources in (("candidates a step", "candidates", ("drape_host",)),
                                 ("contacts a step", "contacts", ("drape_host", "drape")),
                                 ("contacts less redundant ones", "contacts", ("drape_host_reduced", "drape_reduced"))):
        counts = [[row for method in sources for row in select(rows, scene=scene, method=method, stage="step")]
                  for scene in scenes]
        if any(counts):
            lines.append([label] + [f"{row[0][what]:,.0f}" if row else "–" for row in counts])
    return ("Whole step, host to host, ms: median (95th percentile). Same scene, same step, same process.\n\n"
            + table([""] + [SCENES[scene] for scene in scenes], lines))


def stage_table(rows):
    scenes = [scene for scene in SCENES if select(rows, scene=scene, method="drape_kernels")]
    if not scenes:
        return ""
    lines = []
    for method in ("drape_kernels", "drape_reduced_kernels"):
        all_rows = select(rows, method=method)
        for kernel in in_order([row for row in all_rows if str(row["stage"]).startswith("kernel")], "stage"):
            if method == "drape_kernels" or kernel == "kernels" or kernel.startswith("kernel: reduction"):
                label = kernel.replace("kernel: ", "") + ("" if method == "drape_kernels" else ", reduced")
                lines.append([label] + [figure(next((row.get("median_ms") for row in select(
                    rows, scene=scene, method=method, stage=kernel)), None)) for scene in scenes])
    return ("Kernel time a step, ms, medians, of a run with a profiled queue; the last lines where redundant contacts are "
            "left out:\n\n" + table([""] + [SCENES[scene] for scene in scenes], lines))


def exponent_table(rows):
    lines, faster = [], []
    for sweep, (size, label) in SWEEPS.items():
        for method in ("drape", "drape_kernels", "drape_host", "embree_contacts_2", "fcl_pairs"):
            mine = select(rows, sweep=sweep, method=method)
            for stage in in_order(mine, "stage"):
                points = [(size(row), row["median_ms"]) for row in select(mine, stage=stage) if "median_ms" in row]
                wanted = stage in STAGES or stage in ("step", "kernels")
                if not wanted or len(points) < 3 or (method == "drape_kernels" and stage == "step"):
                    continue
                found = select(mine, stage=stage)
                work = [(row.get("candidates", 0), row["median_ms"]) for row in found if "median_ms" in row]
                grows, bound = fit_exponent(points), n_log_n_exponent([size for size, _ in points])
                if grows is None:
                    continue
                # One cloth has no logarithm: then there is nothing to hold it against.
                over = bound is not None and grows > bound
                lines.append([label, METHODS.get(method, "kernels"), stage, f"**{grows:.2f}**" if over else f"{grows:.2f}",
                              exponent([(size, size * math.log(size)) for size, _ in points if size > 1]), exponent(work)])
                if over and method.startswith("drape"):
                    faster.append(f"{METHODS.get(method, 'kernels')}, {stage} ({label}: {grows:.2f}, n log n: {bound:.2f})")
    if not lines:
        return ""
    verdict = ("Stages of Drape that grow faster than n log n: " + "; ".join(faster) if faster
               else "No stage of Drape grows faster than n log n")
    return ("How times grow: exponent p of the fit time ~ sizeᵖ over each sweep, beside that of n log n at the same sizes "
            f"(bold where it is above), and over the candidates of its scenes. {verdict}.\n\n"
            "<details><summary>exponents</summary>\n\n"
            + table(["size", "method", "stage", "p, size", "n log n", "p, candidates"], lines) + "</details>\n\n")


def exponent(points):
    value = fit_exponent(points)
    return "–" if value is None else f"{value:.2f}"


def memory_table(rows):
    memory = [row for row in select(rows, method="drape") if str(row["stage"]).startswith("memory: ")]
    scenes = [scene for scene in ("thesis", "fine", "static_1m_fine") if select(memory, scene=scene)]
    if not scenes:
        return ""
    lines, sums = [], {}
    for stage in in_order(memory, "stage"):
        name = stage[len("memory: "):]
        line = [name]
        for scene in scenes:
            row = next(iter(select(memory, scene=scene, stage=stage)), None)
            side = "obstacle" if name.startswith("obstacle") else "cloth"
            each = row and row["bytes"] / row[side + "_triangles"]
            line.append("–" if row is None else f"{each:,.1f}")
            sums[scene, side] = sums.get((scene, side), 0) + (each or 0)
        lines.append(line)
    for side in ("cloth", "obstacle"):
        lines.append([f"**sum, a triangle of the {side}**"] + [f"**{sums[scene, side]:,.0f}**" for scene in scenes])
    return ("Device memory, bytes a triangle of its side. Lists of a step and what is of both sides count to the "
            "cloth.\n\n" + table([""] + [SCENES[scene] for scene in scenes], lines))


def trajectories(folders):
    """Contents by name of what holds hashes of simulations."""
    named = {f"{os.path.basename(folder)}/{name}.json": read_json(folder, name)
             for folder in folders for name in ("cloth_drop", "drop_speeds")}
    return {name: content for name, content in named.items() if content}


def pictures(folder):
    names = sorted(name for name in os.listdir(folder) if name.endswith(".png") and not name.startswith("error_"))
    relative = os.path.basename(folder)
    return "".join(f"![{name[:-4]}]({relative}/{name})\n" for name in names) + "\n" if names else ""


def machine_text(folder):
    rows = read_steps(folder)
    machine = read_machine(folder, "bench_step" if rows else "study")
    devices = ", ".join(f"{device['device']} (driver {device['driver']})" for device in machine["devices"]) or "none"
    text = f"## {os.path.basename(folder)}\n\n"
    text += f"{machine['processor']}, {machine['cores']:.0f} cores; OpenCL devices: {devices}. "
    if rows:
        text += f"Whole steps: measured {machine['date']} at commit {machine['commit']}. "
    reference = read_json(folder, "bench_step_reference")
    if reference:
        text += f"The host and the peers there, where not measured anew: at commit {reference['machine']['commit']}. "
    text += "The study's tables say their own commits. " if os.path.exists(os.path.join(folder, "study.csv")) else ""
    text += f"Void rows: {count_void(folder, 'bench_step') + count_void(folder, 'study')}.\n\n"
    text += step_table(rows) + stage_table(rows)
    text += script_tables.cloth_text(read_json(folder, "cloth_drop"), table)
    text += script_tables.drops_text(read_json(folder, "drop_speeds"), table)
    text += script_tables.checks_text(read_json(folder, "drape_check"), table, figure)
    text += study_tables.text(read_rows(folder, "study"), table, figure)
    return text + exponent_table(rows) + memory_table(rows) + pictures(folder)


def replaced(text, name, tables):
    """The text with what is between the markers of that name replaced; None without the markers."""
    begin, end = f"<!-- {name}: made by summary.py -->", f"<!-- end of {name} -->"
    before, found, rest = text.partition(begin)
    _, closed, after = rest.partition(end)
    return before + begin + "\n\n" + tables + end + after if found and closed else None


def read_text(path):
    if not os.path.exists(path):
        return ""
    with open(path) as file:
        return file.read()


def main():
    here = sys.argv[1] if len(sys.argv) > 1 else HERE
    results = os.path.join(here, "results")
    names = sorted(os.listdir(results)) if os.path.isdir(results) else []
    folders = [os.path.join(results, name) for name in names]
    folders = [folder for folder in folders
               if any(os.path.exists(os.path.join(folder, name + ".json")) for name in ("bench_step", "study"))]
    # No table of results of which one must be wrong.
    runs = trajectories(os.path.join(results, name) for name in names)
    for line in hashes.incomparable(runs):
        print("summary.py: " + line, file=sys.stderr)
    differences = hashes.differences(runs)
    if differences:
        sys.exit("\n".join(differences))
    machines = [(os.path.basename(folder), read_rows(folder, "study")) for folder in folders]
    measured = [(name, rows) for name, rows in machines if rows]
    tables = "".join(machine_text(folder) for folder in folders) + study_tables.devices_table(machines, table, figure)
    texts = {os.path.join(results, "README.md"): {"results": tables},
             os.path.join(here, "README.md"): {"front": study_findings.front(measured, table, figure),
                                               "ranking": study_findings.ranking(measured, table, figure)}}
    if not replaced(read_text(os.path.join(results, "README.md")), "results", ""):
        sys.exit(f"{results}/README.md has no markers")
    for path, regions in texts.items():
        text = read_text(path)
        for name, made in regions.items():
            text = replaced(text, name, made) or text
        if text:
            with open(path, "w") as file:
                file.write(text)


if __name__ == "__main__":
    main()
