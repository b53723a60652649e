#!/usr/bin/env bash
# Measures error against run time on this machine: run.sh [options of error_vs_time] OUT_DIR
#
#   --minutes N    time to spend (default 22); every knob's first value on every scene comes first, and what does not
#                  fit is named and left out
#   --models DIR   folder of bunny_69k.obj and dragon_871k.ply; --device, --backend, --cap: see --help
#   --part NAME, --scene NAME, --knob NAME   only these (repeat the last two); defaults are always run beside a knob
#   --truth DIR    folder of ccd_queries.bin and triangle_pairs.bin, published queries with exact answers; without it
#                  only queries whose answers are made here
#   --commit TEXT  what is measured (default: git describe)
#   --bin DIR      folder of the program (default: build/release/bin)
#
# Joins what was measured to error_vs_time.csv and .json in OUT_DIR (merge_errors.py; delete them to begin anew): scenes and
# knobs may be measured run by run. Draws the plots there, and writes the tables of all machines into
# benchmarks/results/README.md where OUT_DIR lies there. Measure on an idle machine. Ends with 3 when a row is void, with 2
# when OUT_DIR is of another machine, with 1 when something is missing.
set -uo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bin=$here/../../build/release/bin
commit=$(git -C "$here" describe --always --dirty 2>/dev/null || echo unknown)
minutes=22 arguments=() quick='' out=''
while [[ $# -gt 0 ]]; do
  case $1 in
    --bin) bin=$2; shift ;;
    --commit) commit=$2; shift ;;
    --minutes) minutes=$2; shift ;;
    --quick) quick=', quick' arguments+=("$1") ;;
    -*) arguments+=("$1" "$2"); shift ;;
    *) out=$1 ;;
  esac
  shift
done
[[ -n $out ]] || { sed -n '2,19s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 2; }
mkdir -p "$out" || exit 1

# Prefers Debian's interpreter, since others do not find its matplotlib.
python=/usr/bin/python3
[[ -x $python ]] || python=python3
work=$(mktemp -d)
"$bin/error_vs_time" --commit "$commit$quick" --minutes "$minutes" "${arguments[@]}" --json "$work/measured.json"
code=$?
[[ -e $work/measured.json ]] || { rmdir "$work"; exit "$code"; }
"$python" "$here/merge_errors.py" "$out" "$work/measured.json"
case $? in
  0) ;;
  3) code=3 ;;
  *) echo "run.sh: not joined: what was measured is in $work" >&2; exit 2 ;;
esac
rm -r "$work"
readme=()
[[ $(cd "$out" && pwd) != "$(cd "$here/.." && pwd)"/results/* ]] || readme=("$here/../results/README.md")
if "$python" -c 'import matplotlib' 2>/dev/null; then
  "$python" "$here/plot.py" "$out" "${readme[@]}" || [[ $code != 0 ]] || code=1
else
  echo "run.sh: no python3-matplotlib here; run error_vs_time/plot.py on $out elsewhere" >&2
fi
exit "$code"
