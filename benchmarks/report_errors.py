"""Tables of error_vs_time: what a frame costs against how wrong the cloth is."""
from results import count, figure, in_order, select, table

NAMES = {"drape": "Drape, device", "drape_host": "Drape, host", "bullet": "Bullet's own",
         "plain": "closest points in floats or doubles"}
# Column, heading, form.
ERRORS = (("penetration_mm", "deepest penetration, mm", figure),
          ("intersecting_pairs", "intersecting pairs, most", count),
          ("nodes_through", "nodes through", count), ("speed_mm_s", "RMS speed, mm/s", figure),
          ("energy_gain", "energy gained", figure), ("shape_error", "shape error", figure))


def knob(row):
    return row["setting"].split()[0]


def is_clean(row):
    return not any(row.get(column) for column in ("penetration_mm", "intersecting_pairs", "nodes_through"))


def scene_lines(rows):
    """Yields every method's defaults and Bullet's best run with another knob: fewest nodes through, then shallowest."""
    for scene in in_order(rows, "scene"):
        mine = select(rows, scene=scene)
        turned = [row for row in select(mine, method="bullet", ended="whole")
                  if knob(row) not in ("defaults", "fall", "rest")]
        best = [min(turned,
                    key=lambda row: (row["nodes_through"], row["penetration_mm"], row["median_ms"]))] if turned else []
        for row in select(mine, setting="defaults") + best:
            line = [scene, NAMES[row["method"]], row["setting"]]
            if row["ended"] == "whole":
                yield (line + [f"{figure(row['median_ms'])} ({figure(row['p95_ms'])})"]
                       + [form(row.get(column)) for column, _, form in ERRORS])
            else:
                yield line + [f"{row['ended']} in frame {row.get('steps', 0) + 1:.0f}"] + ["–"] * len(ERRORS)


def knob_cell(row):
    if row["ended"] != "whole":
        return row["ended"]
    wrong = [f"{form(row[column])} {letter}" for column, letter, form in (
        ("penetration_mm", "mm", figure), ("intersecting_pairs", "p", count), ("nodes_through", "n", count))
             if row.get(column)]
    return figure(row["median_ms"]) + (f" ({', '.join(wrong)})" if wrong else "")


def knob_table(rows):
    scenes, lines = in_order(rows, "scene"), {}
    for method in NAMES:
        for row in select(rows, method=method):
            if knob(row) not in ("fall", "rest"):
                lines.setdefault((NAMES[method], row["setting"]), {})[row["scene"]] = knob_cell(row)
    return ("Median ms of a frame with each setting. Brackets give the errors: deepest penetration in mm, p most intersecting "
            "pairs, n nodes through.\n\n"
            + table(["method", "setting", *scenes],
                    [[*line, *(cells.get(scene, "–") for scene in scenes)] for line, cells in lines.items()]))


def errors_of(row):
    return [row.get(column) or 0 for column in ("penetration_mm", "intersecting_pairs", "nodes_through")]


def pareto_front(rows):
    """Returns the rows than which no other is both as fast and as right, and faster or more right; fastest first."""
    points = [(row["median_ms"], *errors_of(row)) for row in rows]

    def is_beaten(point):
        return any(other != point and all(a <= b for a, b in zip(other, point)) for other in points)
    front = [row for row, point in zip(rows, points) if not is_beaten(point)]
    return sorted(front, key=lambda row: row["median_ms"])


def front_table(rows):
    lines = []
    for scene in in_order(rows, "scene"):
        cells = []
        for methods in (("drape", "drape_host"), ("bullet",)):
            mine = [row for method in methods for row in select(rows, scene=scene, method=method, ended="whole")
                    if knob(row) not in ("fall", "rest")]
            cells.append("; ".join(f"{row['setting']} {knob_cell(row)}" for row in pareto_front(mine)) or "–")
        lines.append([scene, *cells])
    return ("Pareto fronts: settings that no other setting of the same solver beats in time without being more wrong. "
            "Median ms of a frame; brackets as above.\n\n"
            + table(["scene", "Drape, device or host", "Bullet's own"], lines))


def fall_table(rows):
    lines = []
    for scene in in_order(rows, "scene"):
        for method in NAMES:
            mine = select(rows, scene=scene, method=method)
            falls = [row for row in mine if knob(row) == "fall" and row["ended"] in ("whole", "capped")]
            rests = [row for row in mine if knob(row) == "rest" and "speed_mm_s" in row]
            if falls or rests:
                clean = sum(row["ended"] == "whole" and is_clean(row) for row in falls)
                lines.append([scene, NAMES[method], f"{clean} of {len(falls)}",
                              ", ".join(figure(row["speed_mm_s"]) for row in rests) or "–"])
    return ("Random falls without any error, and the RMS speed of nodes at rest, mm/s, a figure for each run:\n\n"
            + table(["scene", "method", "clean falls", "speed at rest"], lines))


def text(rows):
    if not rows:
        return ""
    return ("## Error against run time\n\nFive scenes of 2 s (`error_vs_time`). A frame lasts 1/60 s; its time is the median "
            "(95th percentile).\n\n"
            + table(["scene", "method", "setting", "frame, ms"] + [title for _, title, _ in ERRORS],
                    list(scene_lines(rows)))
            + knob_table(rows) + front_table(rows) + fall_table(rows))


def query_table(rows):
    lines = [[row["scene"], NAMES[row["method"]], row["setting"], f"{1000 * row['median_ms']:.3g}",
              count(row.get("misses")),
              count(row.get("false_hits"))] for row in rows]
    head = ["queries", "method", "setting", "µs a query", "misses", "false hits"]
    return ("## Single queries\n\n" + table(head, lines)) if lines else ""
