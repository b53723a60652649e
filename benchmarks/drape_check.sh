#!/usr/bin/env bash
# Answers published queries with exact answers: drape_check.sh OUT_DIR --truth DIR [options]
#
#   --truth DIR      folder of ccd_queries.bin, triangle_pairs.bin, cloth_ball92.ply and cloth_ball93.ply;
#                    missing files are named and left out
#   --device NAME    part of an OpenCL device's name; may be given again (default: every device)
#   --bin DIR        folder of drape_check (default: BIN, else build/release/bin)
#   --commit TEXT    the measured commit (default: git describe)
#
# Runs ccd, triangles (fast, exact and moller), pairs and step on the host and on the devices. pairs compares each frame
# with itself and both frames, intersecting at thickness 0. Writes OUT_DIR/drape_check.json: the answers of each run
# with commit and machine. Needs drape_check, Bash and Python. Measure on an idle machine. Ends with 1 if something
# could not be measured.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bin=${BIN:-$here/../build/release/bin}
commit=$(git -C "$here" describe --always --dirty 2>/dev/null || echo unknown)
truth='' out='' devices=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --truth) truth=$2; shift ;;
    --device) devices+=("$2"); shift ;;
    --bin) bin=$2; shift ;;
    --commit) commit=$2; shift ;;
    -*) echo "drape_check.sh: unknown option $1" >&2; exit 2 ;;
    *) out=$1 ;;
  esac
  shift
done
[[ -n $out && -n $truth ]] || { sed -n '2,13s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 2; }
mkdir -p "$out"

PYTHONPATH=$here exec python3 - "$bin/drape_check" "$commit" "$truth" "$out/drape_check.json" "${devices[@]}" <<'PYTHON'
import json, os, subprocess, sys

import machine

program, commit, truth, target, *wanted = sys.argv[1:]
# Each question has a key, a name for the variant, arguments, and files of the folder.
QUESTIONS = (("ccd", "", ["ccd"], ["ccd_queries.bin"]),
             ("triangles", "fast", ["triangles", "--mode", "fast"], ["triangle_pairs.bin"]),
             ("triangles", "exact", ["triangles", "--mode", "exact"], ["triangle_pairs.bin"]),
             ("pairs", "frame 92", ["pairs", "--thickness", "0"], ["cloth_ball92.ply"]),
             ("pairs", "frame 93", ["pairs", "--thickness", "0"], ["cloth_ball93.ply"]),
             ("pairs", "92 and 93", ["pairs", "--thickness", "0"], ["cloth_ball92.ply", "cloth_ball93.ply"]),
             ("step", "", ["step"], ["cloth_ball92.ply", "cloth_ball93.ply"]))


def answer(arguments, backend):
    """What drape_check answers, or None, with its reason on standard error."""
    result = subprocess.run([program, *arguments, *backend, "--json", "-"], stdout=subprocess.PIPE, text=True)
    return json.loads(result.stdout) if result.returncode == 0 else None


description = machine.describe(program, commit)
if not wanted:
    wanted = list(dict.fromkeys(device["device"] for device in description["devices"]))
backends = [["--backend", "host"]] + [["--backend", "opencl", "--device", name] for name in wanted]
content, failed = {"machine": description, "rows": []}, False
for key, variant, arguments, names in QUESTIONS:
    files = [os.path.join(truth, name) for name in names]
    if not all(os.path.exists(path) for path in files):
        print(f"drape_check.sh: {' or '.join(names)} is not in {truth}; {key} is left out", file=sys.stderr)
        failed = True
        continue
    for backend in backends:
        found = answer(arguments + files, backend)
        failed = failed or found is None
        if found is not None:
            content["rows"].append({"question": key, **({"mode": variant} if variant else {}), **found})
            print(key, variant, *(f"{name} {value}" for name, value in found.items()))
with open(target, "w") as file:
    json.dump(content, file, indent=2)
    file.write("\n")
sys.exit(failed)
PYTHON
