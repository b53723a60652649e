#!/usr/bin/env bash
# Measures error against run time on this machine: run.sh [options of error_vs_time] OUT_DIR
#
#   --minutes N    time to spend; what does not fit is named and left out (all of it takes two hours or so)
#   --models DIR   folder of bunny_69k.obj and dragon_871k.ply; --device, --backend, --scene, --knob: see --help
#   --bin DIR      folder of the program (default: build/release/bin)
#
# Writes error_vs_time.csv and .json and the plots into OUT_DIR, and the table into benchmarks/README.md where OUT_DIR lies
# under benchmarks/results/. Measure on an idle machine. Ends with 3 when a row is void, with 1 when something is missing.
set -uo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bin=$here/../../build/release/bin
arguments=() out=''
while [[ $# -gt 0 ]]; do
  case $1 in
    --bin) bin=$2; shift ;;
    --quick) arguments+=("$1") ;;
    -*) arguments+=("$1" "$2"); shift ;;
    *) out=$1 ;;
  esac
  shift
done
[[ -n $out ]] || { sed -n '2,11s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 2; }
mkdir -p "$out" || exit 1

commit=$(git -C "$here" describe --always --dirty 2>/dev/null || echo unknown)
"$bin/error_vs_time" --commit "$commit" "${arguments[@]}" --csv "$out/error_vs_time.csv" --json "$out/error_vs_time.json"
code=$?

# Debian's interpreter first: its matplotlib is not seen by others.
python=/usr/bin/python3
[[ -x $python ]] || python=python3
readme=()
[[ $(cd "$out" && pwd) != "$(cd "$here/.." && pwd)"/results/* ]] || readme=("$here/../README.md")
"$python" "$here/plot.py" "$out" "${readme[@]}" || [[ $code != 0 ]] || code=1
exit "$code"
