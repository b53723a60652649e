"""Answers that must be equal: the same scene, settings and commit have one hash, on every back end and machine."""
import re

# Options of cloth_drop that only say where a run takes place. Each has a value.
PLACES = ("--device", "--backend")


def settings_of(options):
    """Returns the options less those that only say where."""
    kept, words = [], iter(options)
    for word in words:
        if word in PLACES:
            next(words, None)
        elif word.partition("=")[0] not in PLACES:
            kept.append(word)
    return tuple(kept)


def answer_of(row):
    """Returns the name of the answer that a method gives; None where methods may differ."""
    method = row["method"]
    if row["program"] == "bench_step" and method.startswith(("drape", "embree_contacts")):
        return "contacts"
    if row["program"] in ("cloth_drop", "drop_speeds"):
        return "drape" if method.startswith("drape") else method
    return None


def differences(machines):
    """Returns a line for each answer with several hashes. machines: (name, rows of the reduced CSV)."""
    found = {}
    for name, rows in machines:
        for row in rows:
            # A commit with local changes is comparable on its machine alone.
            clean = re.fullmatch("[0-9a-f]{7,40}", row["commit"])
            if answer_of(row) and row.get("hash"):
                key = (row["commit"][:7] if clean else name, row["program"], row["scene"], row.get("setting", ""),
                       answer_of(row), row.get("steps"))
                found.setdefault(key, {}).setdefault(row["hash"], []).append(f"{name}, {row['method']}")
    return [f"hashes differ at {' '.join(str(part) for part in key[:5])}: "
            + "; ".join(f"{hash} ({', '.join(dict.fromkeys(who))})" for hash, who in hashes.items())
            for key, hashes in found.items() if len(hashes) > 1]
