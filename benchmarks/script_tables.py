"""Tables of drop_speeds.json."""
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
