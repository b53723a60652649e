#!/usr/bin/env bash
# Throws the cloth of cloth_drop at the bunny: drop_speeds.sh OUT_DIR [options of cloth_drop, e.g. --device NAME]
#
# Runs 2, 10, 50 and 200 m/s for 100 steps with Drape in each of its modes, and Bullet's own collision beside it. Writes
# OUT_DIR/drop_speeds.json, with commit and machine. Prints a table of the most intersecting pairs and nodes on the
# wrong side at the end of any step. The table also has the nodes that went through the bunny, the most contacts, and
# the trajectory's hash. A run that exceeds its time limit is ended; its row covers the steps until then. Needs
# cloth_drop, Bash and Python. Environment: BIN (build/release/bin), BUNNY, COMMIT (git describe), LIMIT (60 s a run),
# SPEEDS and STEPS.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
out=${1:?OUT_DIR}
shift
bin=${BIN:-$here/../build/release/bin}
bunny=${BUNNY:-/usr/share/glmark2/models/bunny.obj}
commit=${COMMIT:-$(git -C "$here" describe --always --dirty 2>/dev/null || echo unknown)}
speeds=${SPEEDS:-2 10 50 200}
steps=${STEPS:-100}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out"
for speed in $speeds; do
  for run in automatic continuous discrete stock tuned; do
    case $run in
      stock | tuned) kind=(--backend bullet --bullet-mode "$run") ;;
      *) kind=(--mode "$run" "$@") ;;
    esac
    # Bullet's own collision may not end a step once the cloth has fallen through.
    status=0
    "$bin/cloth_drop" --obstacle "$bunny" --drop-speed "$speed" --steps "$steps" --time-limit "${LIMIT:-60}" --quiet \
      "${kind[@]}" --json "$work/$speed-$run.json" --csv "$work/$speed-$run.csv" || status=$?
    if [ "$status" -ne 0 ]; then
      echo "drop_speeds.sh: cloth_drop failed ($status) at $speed m/s, $run" >&2
      exit "$status"
    fi
  done
done
PYTHONPATH=$here python3 - "$bin/cloth_drop" "$commit" "$steps" "$work" "$out/drop_speeds.json" "$speeds" "$bunny" "$@" <<'PYTHON'
import csv, json, pathlib, sys

import machine

program, commit, steps, work, target, speeds, bunny, *options = sys.argv[1:]
rows = []
for speed in speeds.split():
    for run in ("automatic", "continuous", "discrete", "stock", "tuned"):
        with open(pathlib.Path(work, f"{speed}-{run}.csv")) as file:
            course = list(csv.DictReader(file))
        whole = json.loads(pathlib.Path(work, f"{speed}-{run}.json").read_text())
        row = {"speed_m_s": float(speed), "run": run,
               "ended": "by the time limit" if "capped_at_step" in whole else "whole",
               "steps": len(course)}
        for key, column in (("intersecting_pairs_max", "intersecting_pairs"),
                            ("nodes_below_surface_max", "nodes_below_surface")):
            row[key] = max((int(step[column] or 0) for step in course), default=None)
        for key in ("device", "nodes_below_surface", "nodes_through", "penetration_max_m", "contacts_max", "hash"):
            row[key] = whole.get(key)
        rows.append(row)
with open(target, "w") as file:
    json.dump({"machine": machine.describe(program, commit), "scene": machine.scene(bunny, options),
               "steps": int(steps), "rows": rows}, file, indent=2)
    file.write("\n")
for row in rows:
    print(*(row[key] for key in ("speed_m_s", "run", "ended", "steps", "intersecting_pairs_max", "nodes_below_surface_max",
                                 "nodes_through", "contacts_max", "hash")))
PYTHON
