#!/usr/bin/env bash
# Measures everything on this machine: run_all.sh [options] OUT_DIR
#
#   --device NAME    part of an OpenCL device's name (default: the first GPU, else the first device)
#   --models DIR     folder of bunny_69k.obj, dragon_871k.ply, spot_6k.obj; what is not there is left out
#   --bin DIR        folder of the programs (default: build/release/bin; those of the study in other volumes are made by
#                    the target study_degrees)
#   --minutes N      time to spend (default 80); what does not fit is named and left out
#   --truth DIR      folder of published queries with exact answers, see error_vs_time/run.sh and drape_check.sh
#   --commit TEXT    what is measured (default: git describe)
#   --reference DIR  OUT_DIR of an earlier run: contacts must have its hashes, and the host and the peers are not
#                    measured again; they are copied, for the tables, as bench_step_reference.csv and .json
#   --quick          small inputs only
#
# Writes bench_step.csv and .json, study.csv and .json (run_study.sh alone does these, also part by part), and, where
# Bullet's part is built, error_vs_time.csv and .json, cloth_drop.json and drop_speeds.json (of the bunny; no drops with
# --quick), with --truth drape_check.json; then the plots beside them, and the tables in results/README.md and README.md
# here where OUT_DIR lies under results/. Measure on an idle machine. Ends with 3 when a row is void, with 1 when
# something could not be measured.
set -uo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bin=$here/../build/release/bin
commit=$(git -C "$here" describe --always --dirty 2>/dev/null || echo unknown)
minutes=80 device='' models='' truth='' reference='' quick='' out=''
while [[ $# -gt 0 ]]; do
  case $1 in
    --device) device=$2; shift ;;
    --models) models=$2; shift ;;
    --truth) truth=$2; shift ;;
    --bin) bin=$2; shift ;;
    --minutes) minutes=$2; shift ;;
    --commit) commit=$2; shift ;;
    --reference) reference=$2; shift ;;
    --quick) quick=yes ;;
    -*) echo "run_all.sh: unknown option $1" >&2; exit 2 ;;
    *) out=$1 ;;
  esac
  shift
done
[[ -n $out ]] || { sed -n '2,21s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 2; }
mkdir -p "$out" || exit 1

common=(--commit "$commit")
[[ -z $device ]] || common+=(--device "$device")
[[ -z $models ]] || common+=(--models "$models")
[[ -z $quick ]] || common+=(--quick)

worst=0
# minutes_of SHARE
minutes_of() { awk "BEGIN { print $minutes * $1 }"; }
# note CODE: remembers the worst
note() { [[ $1 == 0 || ($worst == 3 && $1 == 1) ]] || worst=$1; }
# measure NAME SHARE_OF_THE_MINUTES ARGUMENTS…
measure() {
  local name=$1 share=$2
  shift 2
  "$bin/$name" "${common[@]}" --minutes "$(minutes_of "$share")" \
    --csv "$out/$name.csv" --json "$out/$name.json" "$@"
  note $?
}

step=()
if [[ -n $reference ]]; then
  step=(--reference "$reference/bench_step.json" --method drape --method drape_kernels)
  for kind in csv json; do cp "$reference/bench_step.$kind" "$out/bench_step_reference.$kind" || worst=1; done
fi
measure bench_step 0.41 "${step[@]}"
bash "$here/run_study.sh" --bin "$bin" "${common[@]}" --minutes "$(minutes_of 0.27)" "$out"
note $?

bunny=/usr/share/glmark2/models/bunny.obj
[[ -z $models || ! -f $models/bunny_69k.obj ]] || bunny=$models/bunny_69k.obj
if [[ -z $quick && -x $bin/cloth_drop && -f $bunny ]]; then
  BIN=$bin BUNNY=$bunny COMMIT=$commit bash "$here/cloth_drop.sh" "$out" ${device:+--device "$device"} || worst=1
  # The slow runs are Bullet's and the discrete ones, twelve: 0.04 of the minutes.
  BIN=$bin BUNNY=$bunny COMMIT=$commit LIMIT=$(minutes_of 0.2) \
    bash "$here/drop_speeds.sh" "$out" ${device:+--device "$device"} || worst=1
fi

if [[ -n $truth ]]; then
  bash "$here/drape_check.sh" "$out" --truth "$truth" --bin "$bin" --commit "$commit" ${device:+--device "$device"} ||
    worst=1
fi

if [[ -x $bin/error_vs_time ]]; then
  bash "$here/error_vs_time/run.sh" --bin "$bin" "${common[@]}" --minutes "$(minutes_of 0.25)" \
    ${truth:+--truth "$truth"} "$out"
  note $?
fi

# Prefers Debian's interpreter, since others do not find its matplotlib.
python=/usr/bin/python3
[[ -x $python ]] || python=python3
if "$python" -c 'import matplotlib' 2>/dev/null; then
  "$python" "$here/plot.py" "$out" || worst=1
  if [[ $(cd "$out" && pwd) == "$here"/results/* ]]; then "$python" "$here/summary.py" || worst=1; fi
else
  echo "run_all.sh: no python3-matplotlib here; run plot.py and summary.py on $out elsewhere" >&2
fi
exit "$worst"
