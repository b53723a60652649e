#!/usr/bin/env bash
# Measures everything on this machine: run_all.sh [options] OUT_DIR
#
#   --device NAME    part of an OpenCL device's name (default: the first GPU, else the first device)
#   --models DIR     folder of bunny_69k.obj, dragon_871k.ply, spot_6k.obj (default: DRAPE_MODELS_DIR, then Debian's
#                    bunny); what is not there is named and left out
#   --truth DIR      folder of published queries with exact answers, see drape_check.sh
#   --bin DIR        folder of the programs (default: build/release/bin); nothing is built
#   --minutes N      time to spend (default 60); what does not fit is named and left out
#   --commit TEXT    what is measured (default: git describe)
#   --reference DIR  OUT_DIR of an earlier run: contacts must have its hashes, and host and peers are not measured again
#   --quick          small inputs only
#
# Writes raw JSON to OUT_DIR, and results.csv, results.md and plots made from it. Measure on an idle machine. Ends with
# 3 when a row is void, with 1 when something could not be measured.
set -uo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bin=$here/../build/release/bin
commit=$(git -C "$here" describe --always --dirty 2>/dev/null || echo unknown)
minutes=60 device='' models='' truth='' reference='' quick='' out=''
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
[[ -n $out ]] || { sed -n '2,16s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 2; }
mkdir -p "$out" || exit 1

worst=0
# note CODE: remembers the worst
note() { [[ $1 == 0 || ($worst == 3 && $1 == 1) ]] || worst=$1; }
# measure NAME SHARE_OF_THE_MINUTES ARGUMENTS…
measure() {
  local name=$1 share=$2
  shift 2
  "$bin/$name" --commit "$commit" ${device:+--device "$device"} ${models:+--models "$models"} ${quick:+--quick} \
    --minutes "$(awk "BEGIN { print $minutes * $share }")" --json "$out/$name.json" "$@"
  note $?
}

measure bench_step 0.55 \
  ${reference:+--reference "$reference/bench_step.json" --method drape --method drape_kernels}
[[ ! -x $bin/error_vs_time ]] || measure error_vs_time 0.35 ${truth:+--truth "$truth"}

bunny=/usr/share/glmark2/models/bunny.obj
[[ ! -f $models/bunny_69k.obj ]] || bunny=$models/bunny_69k.obj
if [[ -z $quick && -x $bin/cloth_drop && -f $bunny ]]; then
  for script in cloth_drop drop_speeds; do
    BIN=$bin BUNNY=$bunny COMMIT=$commit bash "$here/$script.sh" "$out" ${device:+--device "$device"}
    note $?
  done
fi
if [[ -n $truth ]]; then
  bash "$here/drape_check.sh" "$out" --truth "$truth" --bin "$bin" --commit "$commit" ${device:+--device "$device"}
  note $?
fi

# Debian's interpreter first: others do not see its matplotlib.
python=/usr/bin/python3
[[ -x $python ]] || python=python3
"$python" "$here/reduce.py" "$out" "$out/results.csv"
note $?
plots=()
! "$python" -c 'import matplotlib' 2>/dev/null || plots=(--plots "$out")
"$python" "$here/report.py" "$out/results.csv" "${plots[@]}"
note $?
exit "$worst"
