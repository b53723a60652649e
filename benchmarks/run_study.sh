#!/usr/bin/env bash
# Measures the study on one device, all of it or part by part: run_study.sh [options] OUT_DIR
#
#   --device NAME    part of an OpenCL device's name (default: the first GPU, else the first device)
#   --models DIR     folder of bunny_69k.obj, dragon_871k.ply, spot_6k.obj (default: DRAPE_MODELS_DIR, then Debian's
#                    bunny); what is not there is named and left out
#   --bin DIR        folder of study, study_dop6, study_dop14 and study_dop26 (default: build/release/bin); nothing is
#                    built
#   --parts A,B,…    only these: peers, construction, refit, quality, shape, degree, traversal, builder,
#                    obstacles, triangle_tests
#   --only A,B,…     only these models and scenes, by the names in the tables
#   --minutes N      time to spend (default 30), shared out over the parts; what does not fit is named and left out
#   --repeats N, --seconds N    of one measurement, at most (defaults of study)
#   --commit TEXT    what is measured (default: git describe)
#   --quick          small inputs only
#
# Joins what was measured to OUT_DIR/study.json and study.csv after every part (merge_study.py): parts may be measured
# one after the other, in any order, into one OUT_DIR, and what a part measured before is replaced. Then draws the plots
# beside them, and writes the tables into results/README.md and README.md here where OUT_DIR lies under results/. Needs
# python3, for plots with matplotlib. Measure on an idle machine. Ends with 3 when a row is void, with 1 when something
# could not be measured or judged.
set -uo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bin=$here/../build/release/bin
commit=$(git -C "$here" describe --always --dirty 2>/dev/null || echo unknown)
# Shares of the time: what a part took of it, on a GPU and on two cores.
declare -A shares=([peers]=2 [construction]=6 [refit]=1 [quality]=2 [shape]=3 [degree]=8 [traversal]=8 [builder]=3
  [obstacles]=1 [triangle_tests]=1)
all=peers,construction,refit,quality,shape,degree,traversal,builder,obstacles,triangle_tests
parts=$all minutes=30 arguments=() only='' out=''
while [[ $# -gt 0 ]]; do
  case $1 in
    --bin) bin=$2; shift ;;
    --commit) commit=$2; shift ;;
    --minutes) minutes=$2; shift ;;
    --parts) parts=$2; shift ;;
    --only) only=$2; for name in ${2//,/ }; do arguments+=(--only "$name"); done; shift ;;
    --device | --models | --repeats | --seconds) arguments+=("$1" "$2"); shift ;;
    --quick) arguments+=("$1") ;;
    -*) echo "run_study.sh: unknown option $1" >&2; exit 2 ;;
    *) out=$1 ;;
  esac
  shift
done
[[ -n $out ]] || { sed -n '2,23s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 2; }
for part in ${parts//,/ }; do
  [[ -n ${shares[$part]:-} ]] || { echo "run_study.sh: no part $part; there are $all" >&2; exit 2; }
done
mkdir -p "$out" || exit 1
# Debian's interpreter first: its matplotlib is not seen by others.
python=/usr/bin/python3
[[ -x $python ]] || python=python3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

worst=0
# note CODE: remembers the worst
note() { [[ $1 == 0 || ($worst == 3 && $1 == 1) ]] || worst=$1; }
# minutes_for SHARE: of the time that is left, for a share of what is left to do
begin=$SECONDS
sum=0
for part in ${parts//,/ }; do sum=$((sum + shares[$part])); done
minutes_for() { awk "BEGIN { left = $minutes - $((SECONDS - begin)) / 60; print (left < 0.02 ? 0.02 : left) * $1 / $sum }"; }
# measure PROGRAM PART MINUTES NAME [options]: into $work/NAME.json, joined to what is there
measure() {
  local program=$1 part=$2 share=$3 name=$4
  shift 4
  if [[ ! -x $bin/$program ]]; then
    echo "run_study.sh: $part: no $bin/$program (target study_degrees)" >&2
    note 1
    return
  fi
  "$bin/$program" --commit "$commit" --part "$part" --minutes "$share" --json "$work/$name.json" --csv "$work/$name.csv" \
    "${arguments[@]}" "$@"
  local code=$?
  # Without a row: nothing of the part is wanted, or fitted.
  [[ -e $work/$name.json || $code != 2 ]] || code=$([[ -n $only ]] && echo 0 || echo 1)
  note "$code"
  [[ ! -e $work/$name.json ]] || "$python" "$here/merge_study.py" "$out" "$work/$name.json" || [[ $? == 3 ]] || note 1
}

for part in ${parts//,/ }; do
  if [[ $part == degree ]]; then
    each=$(minutes_for "$(awk "BEGIN { print ${shares[$part]} / 4 }")")
    measure study degree "$each" degree
    if [[ -e $work/degree.json ]]; then
      for sides in 6 14 26; do
        measure "study_dop$sides" degree "$each" "degree_$sides" --reference "$work/degree.json"
      done
    else
      echo "run_study.sh: degree: 6, 14 and 26 sides: left out: no rows of 18 sides to judge them by" >&2
      [[ -n $only ]] || note 1
    fi
  else
    measure study "$part" "$(minutes_for "${shares[$part]}")" "$part"
  fi
  sum=$((sum - shares[$part]))
done

if [[ -e $out/study.json ]] && "$python" -c 'import matplotlib' 2>/dev/null; then
  "$python" "$here/plot.py" "$out" || note 1
  [[ $(cd "$out" && pwd) != "$here"/results/* ]] || "$python" "$here/summary.py" || note 1
else
  echo "run_study.sh: nothing to draw or no python3-matplotlib here; run plot.py and summary.py on $out elsewhere" >&2
fi
exit "$worst"
