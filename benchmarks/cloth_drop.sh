#!/usr/bin/env bash
# The thesis's scene, a cloth dropped on the bunny, on every back end: cloth_drop.sh OUT_DIR [options]
#
#   --device NAME    part of an OpenCL device's name; may be given again (default: every device)
#   --no-compare     without Bullet's own collision, stock and tuned, which takes minutes
#   other options    are cloth_drop's, of every run (as --cloth 65x65)
#
# Runs 240 steps on each device and on the host back end, and Bullet's own collision beside the first. Writes
# OUT_DIR/cloth_drop.json: the summary of each run with commit, machine, scene and options. Prints a table: times of the
# collision and of finding contacts, deepest penetration, intersecting pairs at the end, nodes that went through, and
# the trajectory's hash. Needs cloth_drop, Bash and Python. Measure on an idle machine. Ends with 1 if a run failed or
# Drape's back ends differ. Environment: BIN (build/release/bin), BUNNY, COMMIT (git describe), and STEPS.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bin=${BIN:-$here/../build/release/bin}
bunny=${BUNNY:-/usr/share/glmark2/models/bunny.obj}
commit=${COMMIT:-$(git -C "$here" describe --always --dirty 2>/dev/null || echo unknown)}
out=${1:?OUT_DIR}
shift
compare=yes devices=() options=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --device) devices+=("${2:?--device NAME}"); shift ;;
    --no-compare) compare='' ;;
    *) options+=("$1") ;;
  esac
  shift
done
mkdir -p "$out"

PYTHONPATH=$here exec python3 - "$bin/cloth_drop" "$commit" "$bunny" "${STEPS:-240}" "$compare" "$out/cloth_drop.json" \
  "$(printf '%s\n' "${devices[@]}")" "${options[@]}" <<'PYTHON'
import json, subprocess, sys

import hashes, machine, reduce

program, commit, bunny, steps, compare, target, wanted, *options = sys.argv[1:]


def drop(arguments):
    """What cloth_drop says of a run, None where that is nothing, and whether it went well."""
    result = subprocess.run([program, "--obstacle", bunny, "--steps", steps, "--quiet", "--json", "-",
                             *options, *arguments],
                            stdout=subprocess.PIPE, text=True)
    return json.loads(result.stdout) if result.stdout else None, result.returncode == 0


description = machine.describe(program, commit)
names = list(filter(None, wanted.splitlines()))
if not names:
    names = list(dict.fromkeys(device["device"] for device in description["devices"]))
backends = [["--backend", "opencl", "--device", name] for name in names] + [["--backend", "host"]]
content = {"machine": description, "scene": machine.scene(bunny, options), "steps": int(steps), "rows": []}
failed = False
for index, backend in enumerate(backends):
    comparing = compare and index == 0
    found, good = drop(backend + bool(comparing) * ["--compare"])
    failed = failed or not good
    runs = {} if found is None else found if comparing else {"drape": found}
    for run in ("drape", "bullet_stock", "bullet_tuned"):
        if run in runs:
            content["rows"].append({"run": run, **runs[run]})
with open(target, "w") as file:
    json.dump(content, file, indent=2)
    file.write("\n")
worlds = reduce.worlds([(row, content) for row in content["rows"]])
reduced = [{"program": "cloth_drop", "commit": commit, **row} for row in worlds]
for row in reduced:
    print(*(row.get(name, "") for name in ("method", "device", "setting", "stage", "median_ms", "p95_ms",
                                           "penetration_mm", "intersecting_pairs", "nodes_through", "ended", "hash")))
differences = hashes.differences([(target, reduced)])
for line in differences:
    print("cloth_drop.sh: " + line, file=sys.stderr)
sys.exit(bool(failed or differences))
PYTHON
