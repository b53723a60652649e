#!/usr/bin/env bash
# Measures the study on one device and makes the thesis's tables: run.sh [options] OUT_DIR
#
#   --device NAME    part of an OpenCL device's name (default: the first GPU, else the first device)
#   --models DIR     folder of bunny_69k.obj, dragon_871k.ply, spot_6k.obj (default: DRAPE_MODELS_DIR, then Debian's
#                    bunny); what is not there is named and left out
#   --bin DIR        folder of study, study_dop6, study_dop14 and study_dop26 (default: build/release/bin); nothing is
#                    built
#   --parts A,B,…    only these parts; study --list names them
#   --only A,B,…     only these models and scenes
#   --minutes N      time to spend (default 30); what does not fit is named and left out
#   --repeats N, --seconds N    limits of one measurement
#   --commit TEXT    what is measured (default: git describe)
#   --quick          small inputs only
#
# Writes OUT_DIR/study_PART.json for each part, and study.csv, tables.md and plots made from all parts in OUT_DIR. Parts
# can be measured one after the other. Measure on an idle machine. Ends with 3 when a row is void, with 1 when something
# could not be measured.
set -uo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bin=$here/../build/release/bin
commit=$(git -C "$here" describe --always --dirty 2>/dev/null || echo unknown)
# Shares of the time, from runs on a GPU and on two cores.
declare -A shares=([peers]=2 [construction]=6 [refit]=1 [quality]=2 [shape]=3 [degree]=8 [traversal]=8 [builder]=3
  [obstacles]=1 [triangle_tests]=1)
parts=peers,construction,refit,quality,shape,degree,traversal,builder,obstacles,triangle_tests
minutes=30 arguments=() out=''
while [[ $# -gt 0 ]]; do
  case $1 in
    --bin) bin=$2; shift ;;
    --commit) commit=$2; shift ;;
    --minutes) minutes=$2; shift ;;
    --parts) parts=$2; shift ;;
    --only) for name in ${2//,/ }; do arguments+=(--only "$name"); done; shift ;;
    --device | --models | --repeats | --seconds) arguments+=("$1" "$2"); shift ;;
    --quick) arguments+=("$1") ;;
    -*) echo "run.sh: unknown option $1" >&2; exit 2 ;;
    *) out=$1 ;;
  esac
  shift
done
[[ -n $out ]] || { sed -n '2,18s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 2; }
mkdir -p "$out" || exit 1

worst=0 sum=0
# note CODE: remembers the worst
note() { [[ $1 == 0 || ($worst == 3 && $1 == 1) ]] || worst=$1; }
for part in ${parts//,/ }; do sum=$((sum + ${shares[$part]:-1})); done
# measure PROGRAM PART SHARE NAME [options]: writes OUT_DIR/study_NAME.json
measure() {
  local program=$1 part=$2 share=$3 name=$4
  shift 4
  if [[ ! -x $bin/$program ]]; then
    echo "run.sh: $part: no $bin/$program (target study_degrees)" >&2
    note 1
    return
  fi
  "$bin/$program" --commit "$commit" --part "$part" --minutes "$(awk "BEGIN { print $minutes * $share / $sum }")" \
    --json "$out/study_$name.json" "${arguments[@]}" "$@"
  note $?
}

for part in ${parts//,/ }; do
  if [[ $part == degree ]]; then
    measure study degree 2 degree_18
    for sides in 6 14 26; do
      measure "study_dop$sides" degree 2 "degree_$sides" --reference "$out/study_degree_18.json"
    done
  else
    measure study "$part" "${shares[$part]:-1}" "$part"
  fi
done

# Debian's interpreter first: others do not see its matplotlib.
python=/usr/bin/python3
[[ -x $python ]] || python=python3
"$python" "$here/reduce.py" "$out" "$out/study.csv"
note $?
plots=()
! "$python" -c 'import matplotlib' 2>/dev/null || plots=(--plots "$out")
"$python" "$here/report.py" "$out/study.csv" --tables "$out/tables.md" "${plots[@]}"
note $?
exit "$worst"
