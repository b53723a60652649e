"""Tables of cloth_drop.json, drop_speeds.json and drape_check.json."""
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


BUILT_IN = {"bullet_stock": RUNS["stock"], "bullet_tuned": RUNS["tuned"]}


def count(value):
    """Older results do not say all."""
    return "–" if value is None else f"{value:,}"


def cloth_line(row):
    """A run of cloth_drop.json in words: what it is, its collision and what of it is finding contacts (medians), what
    went wrong, and its hash."""
    what = BUILT_IN.get(row["run"]) or ("Drape, all contacts" if row["all_contacts"] else "Drape")
    where = row["device"] + (f", {row['steps']} steps, ended by the limit of time" if "capped_at_step" in row else "")
    times, finding = row["collision_ms"], row.get("finding_ms")
    # A run without a step in contact has no times of such steps.
    return [what, where, f"{times['median']:,.2f} ({times['p95']:,.2f})" if times else count(None),
            f"{finding['median']:,.2f}" if finding else count(None), f"{1000 * row['penetration_max_m']:,.0f}",
            count(row["intersecting_pairs_end"]), count(row["nodes_below_surface"]), count(row["nodes_through"]),
            f"`{row['hash']}`"]


def cloth_text(content, table):
    """The thesis's scene as a simulation, on every back end. Nothing of results of before that say no commit."""
    if not content or "rows" not in content:
        return ""
    columns = ["", "on", "collision, ms", "finding, ms", "deepest penetration, mm", "intersecting pairs, end",
               "nodes inside, end", "nodes that went through", "hash"]
    return (f"The thesis's scene simulated for {content['steps']} steps (`cloth_drop.sh`): collision a step in contact, "
            "median (95th percentile), what of it is finding contacts (Bullet's figures have no more in them: its solver "
            "holds its contacts), and what an independent check saw:\n\n"
            + table(columns, [cloth_line(row) for row in content["rows"]]) + measured(content))


def drop_cell(rows, whole_steps):
    if not rows:
        return "–"
    row = rows[0]
    if row.get("intersecting_pairs_max") is None:
        return "time limit"
    depth = f"{1000 * row['penetration_max_m']:,.0f}"
    nodes = f"{count(row.get('nodes_below_surface_max'))} / {count(row.get('nodes_through'))}"
    text = f"{row['intersecting_pairs_max']:,} / {nodes} / {depth}"
    if row["contacts_max"] == 0:
        text += ", no contact"
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
            "step / most nodes on the wrong side then / nodes that ever went through its surface / deepest penetration, mm; "
            "and how many steps there were, where the limit of time ended the run.\n\n"
            + table([""] + [f"{speed:g} m/s" for speed in speeds], lines) + measured(content))


def checks_text(content, table, figure):
    """Published queries with exact answers, and the step of the cloth ball."""
    if not content:
        return ""
    lines = [[" ".join(filter(None, (key, row.get("mode")))), row["device"], f"{row['queries']:,}", f"{row['misses']:,}",
              f"{row['false_hits']:,}", figure(row["us_per_query"])]
             for key in ("ccd", "triangles") for row in content.get(key, [])]
    text = ("Published queries with exact answers (`drape_check.sh`):\n\n"
            + table(["", "on", "queries", "misses", "false hits", "µs a query"], lines)) if lines else ""
    pairs = [[row["mode"], row["device"], f"{row['candidates']:,}", f"{row['intersecting_pairs']:,}", figure(row["ms"])]
             for row in content.get("pairs", [])]
    if pairs:
        text += ("Intersecting triangles of the cloth ball, 92,230 of them, that share no vertex (`pairs`); true are 61,530 in "
                 "frame 92 and 97,320 in frame 93:\n\n"
                 + table(["", "on", "candidates", "intersecting", "ms"], pairs))
    steps = [[row["device"], f"{row['vf_candidates']:,}", f"{row['vf_hits']:,}", f"{row['ee_candidates']:,}",
              f"{row['ee_hits']:,}", figure(row["ms"])] for row in content.get("step", [])]
    if steps:
        text += ("The cloth ball's step against itself, 92,230 triangles; true are 19,032 vertex-face and 94,822 edge-edge "
                 "pairs:\n\n" + table(["on", "vertex-face candidates", "hits", "edge-edge candidates", "hits", "ms"], steps))
    return text + measured(content) if text else ""
