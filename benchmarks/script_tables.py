"""Tables of drop_speeds.json and drape_check.json."""
from results import in_order, select

RUNS = {
    "automatic": "Drape, automatic",
    "continuous": "Drape, continuous",
    "discrete": "Drape, discrete",
    "stock": "Bullet built in, stock",
    "tuned": "Bullet built in, tuned",
}


def measured(content):
    """Nothing of results that do not say it."""
    machine = content.get("machine")
    return f"*Measured {machine['date']} at {machine['commit']}.*\n\n" if machine else ""


def drop_cell(rows, whole_steps):
    if not rows:
        return "–"
    row = rows[0]
    if row.get("intersecting_pairs_max") is None:
        return "time limit"
    depth = f"{1000 * row['penetration_max_m']:,.0f}"
    text = f"{row['intersecting_pairs_max']:,} / {row['nodes_below_surface']:,} / {depth}"
    if row["contacts_max"] == 0:
        text = "no contact"
    return text if row["ended"] == "whole" else f"{text}, {row['steps']} of {whole_steps} steps"


def drops_text(content, table):
    """Cloth thrown at the bunny: what went wrong by run and speed."""
    if not content:
        return ""
    rows = content["rows"]
    speeds = in_order(rows, "speed_m_s")
    lines = [[label] + [drop_cell(select(rows, run=run, speed_m_s=speed), content["steps"]) for speed in speeds]
             for run, label in RUNS.items() if select(rows, run=run)]
    return ("The cloth of the thesis scene thrown at the bunny (`drop_speeds.sh`): most intersecting pairs at the end of a "
            "step / nodes on the wrong side after the last / deepest penetration, mm; and how many steps there were, where "
            "the limit of time ended the run. A cloth without a contact went past the bunny or through it.\n\n" + table([""] + [f"{speed:g} m/s" for speed in speeds], lines) + measured(content))


def checks_text(content, table, figure):
    """Published queries with exact answers, and the step of the cloth ball."""
    if not content:
        return ""
    lines = [[" ".join(filter(None, (key, row.get("mode")))), row["device"], f"{row['queries']:,}", f"{row['misses']:,}",
              f"{row['false_hits']:,}", figure(row["us_per_query"])]
             for key in ("ccd", "triangles") for row in content.get(key, [])]
    text = ("Published queries with exact answers (`drape_check.sh`):\n\n"
            + table(["", "on", "queries", "misses", "false hits", "µs a query"], lines)) if lines else ""
    steps = [[row["device"], f"{row['vf_candidates']:,}", f"{row['vf_hits']:,}", f"{row['ee_candidates']:,}",
              f"{row['ee_hits']:,}", figure(row["ms"])] for row in content.get("step", [])]
    if steps:
        text += ("The cloth ball's step against itself, 92,230 triangles; true are 19,032 vertex-face and 94,822 edge-edge "
                 "pairs:\n\n" + table(["on", "vertex-face candidates", "hits", "edge-edge candidates", "hits", "ms"], steps))
    return text + measured(content) if text else ""
