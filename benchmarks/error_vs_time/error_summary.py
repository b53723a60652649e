"""The tables of error against run time in benchmarks/results/README.md. plot.py writes them."""
import os

from results import count_void, in_order, read_json, read_rows, select

# Column, what it says, file name of its figure.
SIMULATION_ERRORS = (
    ("penetration_max", "deepest penetration / thickness", "penetration"),
    ("penetration_p99", "penetration / thickness, 99th percentile", "penetration_p99"),
    ("intersecting_max", "most intersecting pairs at the end of a step", "pairs"),
    ("nodes_through", "nodes that went through the obstacle", "through"),
    ("late_speed_mm_s", "RMS speed in the last tenth of the run, mm/s", "late_speed"),
    ("rest_speed_mm_s", "RMS speed at rest, mm/s", "rest"),
    ("energy_rise", "rise of kinetic and height energy / energy of the fall", "energy_rise"),
    ("energy_gain", "rise of energy that no link had held / energy of the fall", "energy"),
    ("shape_error", "shape against small steps / thickness", "shape"),
)
IN_TABLE = ("penetration_max", "intersecting_max", "nodes_through", "late_speed_mm_s", "energy_rise", "energy_gain",
            "shape_error")
COUNTS = ("intersecting_max", "nodes_through")
NAMES = {"drape": "Drape, device", "drape_host": "Drape, host", "bullet": "Bullet built in",
         "plain": "closest points, plainly"}
BEGIN = "<!-- error_vs_time: made by plot.py -->"
END = "<!-- end of error_vs_time -->"


def is_drape(row):
    return row["method"] in ("drape", "drape_host")


def is_clean(row):
    """No node below or through the surface and no intersecting pair after any step."""
    return row["ended"] == "whole" and not any(row.get(key) for key in (
        "penetration_max", "nodes_through", "intersecting_max", "invalid_nodes"))


def figure_of(value, digits=2):
    return "–" if value is None else "0" if value == 0 else f"{value:,.{digits}f}" if value < 100 else f"{value:,.0f}"


def count_of(value):
    return figure_of(value, 0)


def setting_of(row):
    if row.get("setting"):
        return f"{row['knob']} {row['setting']}"
    return f"{row['knob']} {row['value']:g}" if row.get("value") else row["knob"]


def table(head, lines):
    return "".join("| " + " | ".join(line) + " |\n" for line in [head, ["---"] * len(head), *lines]) + "\n"


def scene_line(row):
    cells = [row["scene"], NAMES[row["method"]], setting_of(row)]
    if row["ended"] != "whole":
        return cells + [f"{row['ended']} in frame {row.get('frames', 0) + 1:.0f}"] + ["–"] * len(IN_TABLE)
    time = "–" if "frame_median_ms" not in row else \
        f"{figure_of(row['frame_median_ms'])} ({figure_of(row.get('frame_p95_ms'))})"
    return cells + [time] + [(count_of if error in COUNTS else figure_of)(row.get(error)) for error in IN_TABLE]


def scene_rows(rows):
    """Per scene: every method's defaults, and of Bullet's knobs the run with the fewest nodes through, then the shallowest."""
    for scene in in_order(rows, "scene"):
        mine = select(rows, scene=scene)
        yield from select(mine, knob="defaults")
        turned = [row for row in mine if row["method"] == "bullet" and row["knob"] not in ("defaults", "fall", "rest")
                  and row["ended"] == "whole"]
        if turned:
            yield min(turned, key=lambda row: (row.get("nodes_through", 0), row.get("penetration_max", 0)))


def scenes_table(rows):
    labels = {error: label for error, label, _ in SIMULATION_ERRORS}
    return table(["scene", "method", "knob", "frame, ms: median (95 %)"] + [labels[error] for error in IN_TABLE],
                 [scene_line(row) for row in scene_rows(rows)])


def knob_cell(row):
    if row["ended"] != "whole":
        return row["ended"]
    text = figure_of(row.get("frame_median_ms"))
    wrong = [f"{form(row[key])} {letter}" for key, letter, form in
             (("penetration_max", "d", figure_of), ("intersecting_max", "p", count_of), ("nodes_through", "n", count_of))
             if row.get(key)]
    return text + (f" ({', '.join(wrong)})" if wrong else "")


def knobs_table(rows):
    """Every setting that was tried, by scene: ms a frame, and what was wrong."""
    scenes, knobs, methods = in_order(rows, "scene"), in_order(rows, "knob"), list(NAMES)
    lines = {}
    for row in sorted(rows, key=lambda row: (methods.index(row["method"]), knobs.index(row["knob"]), row["value"])):
        if row["knob"] not in ("fall", "rest"):
            lines.setdefault((NAMES[row["method"]], setting_of(row)), {})[row["scene"]] = knob_cell(row)
    return ("Median ms a frame; in brackets what was wrong in any step: d deepest penetration over thickness, p most "
            "intersecting pairs, n nodes through.\n\n") + \
        table(["method", "knob", *scenes], [[*line, *(lines[line].get(scene, "–") for scene in scenes)] for line in lines])


def falls_text(rows):
    """Of falls that differ by chance it can be said how rare an error is: none in N means fewer than 3 / N, at 95 %."""
    lines = []
    for scene in in_order(rows, "scene"):
        for method in NAMES:
            falls = [row for row in select(rows, scene=scene, method=method, knob="fall") if row["ended"] in ("whole", "capped")]
            if not falls:
                continue
            clean = sum(is_clean(row) for row in falls)
            bound = f"{min(300 / len(falls), 100):.3g} %" if clean == len(falls) else "–"
            lines.append([scene, NAMES[method], str(len(falls)), str(clean), bound])
    return ("Falls with a random turn, shift and speed. Clean: without a node below or through the surface and without an "
            "intersecting pair at the end of any step; where all N are, fewer than 3 / N of such falls are not, at 95 %:\n\n") + \
        table(["scene", "method", "falls", "clean", "not clean: fewer than"], lines) if lines else ""


def rest_line(row):
    return [row["scene"], NAMES[row["method"]], f"{row['seed']:.0f}" if row.get("seed") else "flat, from rest",
            row.get("setting", "reduced") if is_drape(row) else "–",
            f"{row['speed_frames']:,.0f} of {row['frames']:,.0f}", figure_of(row["rest_speed_mm_s"], 3), knob_cell(row)]


def rest_text(rows):
    rests = [row for row in select(rows, knob="rest") if "rest_speed_mm_s" in row and "speed_frames" in row]
    if not rests:
        return ""
    return "RMS speed of the cloth over the last frames of a long run, after it settled, and what was wrong until then:\n\n" + \
        table(["scene", "method", "fall", "contacts", "over frames", "mm/s", "ms a frame"], [rest_line(row) for row in rests])


def detector_line(row):
    def error(name, digits="{:.2g}"):
        return digits.format(row[name]) if name in row else "–"
    return [row["scene"], NAMES[row["method"]], setting_of(row), f"{row['query_median_us']:.3g}",
            f"{row['misses']:,.0f} of {row['true_pairs']:,.0f}",
            f"{row['false_hits']:,.0f} of {row['queries'] - row['true_pairs']:,.0f}",
            error("time_error_p50"), error("time_error_max"), error("late_times", "{:,.0f}"), error("distance_error_max"), error("normal_error_deg_p99")]


def detector_table(rows):
    """A device's rows where there are, with the ends of the knobs; all variants are in the CSV file."""
    lines = []
    for scene in in_order(rows, "scene"):
        mine = select(rows, scene=scene)
        if any(row["method"] == "drape" for row in mine):
            mine = [row for row in mine if row["method"] != "drape_host"]
        for row in mine:
            last = [other for other in mine if other["knob"] == row["knob"]][-1]
            if row.get("setting") or row["knob"] == "defaults" or row is last:
                lines.append(detector_line(row))
    return table(["queries", "method", "variant", "µs a query", "misses", "false hits", "time of impact off by, of the step, median",
                  "off by, at most", "late", "distance off by, of the extent, at most", "normal off by, degrees, 99 %"], lines)


def misses_text(rows):
    """Of queries made at random it can be said how rare a miss is."""
    made = [row for row in rows if is_drape(row) and row["knob"] == "defaults" and not row["scene"].startswith("published")]
    named = {row["scene"]: row for row in made}  # of host and device the latter: the same answers
    pairs = sum(row["true_pairs"] for row in named.values())
    if not pairs or any(row["misses"] for row in named.values()):
        return ""
    return (f"Of the queries made here, the defaults of continuous collision and of the contacts missed none of "
            f"{pairs:,.0f} true pairs: fewer than {3 / pairs:.1g} of such pairs are missed, at 95 %.\n\n")


def left_out_text(rows):
    said = []
    for ended, why in (("left out", "of Bullet's, on scenes where it had stalled three times in a row"),
                       ("no time", "for want of time")):
        rows_left = [row for row in rows if row["ended"] == ended]
        if rows_left:
            said.append(f"{len(rows_left)} runs {why} ({', '.join(in_order(rows_left, 'scene'))})")
    return "Left out: " + "; ".join(said) + ".\n\n" if said else ""


def pictures(folder):
    names = sorted(name for name in os.listdir(folder) if name.startswith("error_") and name.endswith(".png"))
    place = os.path.basename(os.path.abspath(folder))
    return "".join(f"![{name[:-4]}]({place}/{name})\n" for name in names) + "\n"


def summary(folder, rows):
    machine = (read_json(folder, "error_vs_time") or {}).get("machine", {})
    text = f"## Error against run time: {os.path.basename(os.path.abspath(folder))}\n\n"
    text += (f"{machine.get('processor', 'unknown processor')}, commit {machine.get('commit', 'unknown')}. "
             f"Void rows: {count_void(folder, 'error_vs_time')}.\n\n")
    simulations, detector = select(rows, part="simulation"), select(rows, part="detector")
    if simulations:
        text += scenes_table(simulations) + falls_text(simulations) + rest_text(simulations) + \
            knobs_table(simulations) + left_out_text(simulations)
    return text + (detector_table(detector) + misses_text(detector) if detector else "") + pictures(folder)


def all_summaries(results):
    """Of every folder of results that has rows, by name."""
    folders = [os.path.join(results, name) for name in sorted(os.listdir(results))]
    found = [(folder, read_rows(folder, "error_vs_time")) for folder in folders]
    return "".join(summary(folder, rows) for folder, rows in found if rows)


def write(readme):
    old = open(readme).read() if os.path.exists(readme) else ""
    if BEGIN not in old:
        old = old.rstrip("\n") + ("\n\n" if old else "") + BEGIN + "\n" + END + "\n"
    before, rest = old.split(BEGIN, 1)
    after = rest.split(END, 1)[1]
    text = all_summaries(os.path.dirname(os.path.abspath(readme)))
    with open(readme, "w") as file:
        file.write(before + BEGIN + "\n\n" + text + END + after)
