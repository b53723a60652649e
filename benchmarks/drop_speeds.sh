#!/usr/bin/env bash
# The cloth of cloth_drop thrown at the bunny: drop_speeds.sh OUT_DIR [options of cloth_drop, as --device NAME]
#
# Runs 2, 10, 50 and 200 m/s for 100 steps with Drape in each of its modes, and Bullet's own collision beside it. Writes
# OUT_DIR/drop_speeds.json and prints a table: the most intersecting pairs at the end of a step, nodes on the wrong side at
# the end, contacts at most, and the trajectory's hash. BIN (build/release/bin), BUNNY and LIMIT (60 s a run) may be set.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
out=${1:?OUT_DIR}
shift
bin=${BIN:-$here/../build/release/bin}
bunny=${BUNNY:-/usr/share/glmark2/models/bunny.obj}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out"
for speed in 2 10 50 200; do
  for run in automatic continuous discrete stock tuned; do
    case $run in
      stock | tuned) kind=(--backend bullet --bullet-mode "$run") ;;
      *) kind=(--mode "$run" "$@") ;;
    esac
    # Bullet's own collision may not end a step once the cloth has fallen through.
    status=0
    timeout "${LIMIT:-60}" "$bin/cloth_drop" --obstacle "$bunny" --drop-speed "$speed" --steps 100 --quiet "${kind[@]}" \
      --json "$work/$speed-$run.json" --csv "$work/$speed-$run.csv" || status=$?
    if [ "$status" -ne 0 ] && [ "$status" -ne 124 ]; then
      echo "drop_speeds.sh: cloth_drop failed ($status) at $speed m/s, $run" >&2
      exit "$status"
    fi
  done
done
exec python3 - "$work" "$out/drop_speeds.json" <<'PYTHON'
import csv, json, pathlib, sys

work, target = pathlib.Path(sys.argv[1]), sys.argv[2]
rows = []
for speed in (2, 10, 50, 200):
    for run in ("automatic", "continuous", "discrete", "stock", "tuned"):
        row = {"speed_m_s": speed, "run": run, "ended": "by the time limit"}
        steps, summary = work / f"{speed}-{run}.csv", work / f"{speed}-{run}.json"
        if steps.exists():
            pairs = [int(step["intersecting_pairs"] or 0) for step in csv.DictReader(steps.open())]
            row["steps"] = len(pairs)
            row["intersecting_pairs_max"] = max(pairs, default=None)
        if summary.exists() and summary.stat().st_size > 0:
            whole = json.loads(summary.read_text())
            row["ended"] = "whole"
            for key in ("device", "nodes_below_surface", "penetration_max_m", "contacts_max", "hash"):
                row[key] = whole.get(key)
        rows.append(row)
with open(target, "w") as file:
    json.dump({"steps": 100, "rows": rows}, file, indent=2)
    file.write("\n")
for row in rows:
    print(*(row.get(key) for key in ("speed_m_s", "run", "ended", "steps", "intersecting_pairs_max", "nodes_below_surface", "contacts_max",
                                     "hash")))
PYTHON
