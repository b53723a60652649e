"""Trajectories of the committed results: the same scene, settings and commit have one hash, on every machine."""
import re

# Options of cloth_drop that say where a run goes, and are of no consequence for it; each has a value.
PLACES = ("--device", "--backend")


def settings_of(options):
    """Options less those that only say where."""
    kept, words = [], iter(options)
    for word in words:
        if word in PLACES:
            next(words, None)
        elif word.partition("=")[0] not in PLACES:
            kept.append(word)
    return tuple(kept)


def commit_of(content, name):
    """The commit as far as it is short; what says none, or one with changes, is comparable within its file alone."""
    commit = content.get("machine", {}).get("commit", "")
    return commit[:7] if re.fullmatch("[0-9a-f]{7,40}", commit) else name


def rows_of(name, content):
    """Pairs of what has to agree and (hash, where it is from) for each row of a cloth_drop.json or drop_speeds.json."""
    scene = content.get("scene") or {}
    common = (commit_of(content, name), scene.get("obstacle_digest") or name, settings_of(scene.get("options", [])))
    for row in content.get("rows", []):
        if not row.get("hash"):
            continue
        run = row["run"].replace("bullet_", "")
        run = "automatic" if run == "drape" else run
        speed, every = float(row.get("speed_m_s", 0)), bool(row.get("all_contacts"))
        label = f"{name}: {run}" + f", {speed:g} m/s" * (speed > 0) + ", all contacts" * every + f" on {row.get('device')}"
        yield (*common, run, speed, every, row["steps"]), (row["hash"], label)


def incomparable(results):
    """A line for each file that does not say what another must have alike."""
    return [f"{name} does not say its commit and scene: its hashes are compared with each other alone"
            for name, content in results.items()
            if commit_of(content, "") == "" or not (content.get("scene") or {}).get("obstacle_digest")]


def differences(results):
    """A line for each run of which results, contents by file name, have several hashes; it names the rows."""
    found = {}
    for name, content in results.items():
        for key, value in rows_of(name, content):
            found.setdefault(key, []).append(value)
    return [f"hashes of one trajectory differ at commit {key[0]} after {key[-1]} steps: "
            + "; ".join(f"{label} {value}" for value, label in rows)
            for key, rows in found.items() if len({value for value, _ in rows}) > 1]
