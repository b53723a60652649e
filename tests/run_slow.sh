#!/usr/bin/env bash
# Builds and runs the slow tier: run_slow.sh [options]
#
# Runs the slow tests, the tests of the study and thousands of random worlds. Measures cloth that must lie still, in
# eight falls on each of four obstacles. Runs the core's unit tests as programs of Windows under Wine, the fast and full
# tiers with the sanitizers, and each fuzzer for five minutes.
#
#   --jobs N              processes at a time (as many as there are cores)
#   --plain-failing N     the most worlds that may fail of 4,000 without modifiers (0)
#   --modified-failing N  the most of 4,000 with random modifiers (0; 1 with Bullet's links, which takes too long)
#   --tiny-failing N      the most of 300,000 tiny ones (11)
#   --ropes-failing N     the most of 2,000 with ropes (0)
#   --skirts-failing N    the most of the two grids' 354 skirts (0)
#
# Runs all parts, also after one that fails; the exit code is 1 then. Failing worlds are printed with the options that
# repeat them. Takes some 110 minutes on two idle cores.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export DRAPE_WARNINGS_AS_ERRORS=${DRAPE_WARNINGS_AS_ERRORS-ON}

jobs=$(nproc)
plain=0
modified=
tiny=11
skirts=0
ropes=0
while [[ $# -gt 0 ]]; do
  [[ $# -ge 2 && $2 =~ ^[0-9]+$ ]] || { echo "run_slow.sh: $1 needs a number" >&2; exit 2; }
  case $1 in
    --jobs) jobs=$2 ;;
    --plain-failing) plain=$2 ;;
    --modified-failing) modified=$2 ;;
    --tiny-failing) tiny=$2 ;;
    --skirts-failing) skirts=$2 ;;
    --ropes-failing) ropes=$2 ;;
    *) echo "run_slow.sh: $1 is no option" >&2; exit 2 ;;
  esac
  shift 2
done

bash cmake/install_packages.sh
bash cmake/build_preset.sh release all study study_dop6 drape_test_study
bash cmake/build_preset.sh host

failed=0
source tests/reference_data.sh
ctest --test-dir build/release --output-on-failure --no-tests=error --label-regex '^slow$' \
  --parallel "$(nproc)" || failed=1
# The build without OpenCL, used by other projects.
libdir=$(sed -n 's/^CMAKE_INSTALL_LIBDIR:PATH=//p' build/host/CMakeCache.txt)
cmake -D BUILD="$PWD/build/host" -D SOURCE="$PWD/examples/consumer" -D DOCUMENTS="$PWD" \
  -D WORK="$PWD/build/host/consumer" -D LIBDIR="$libdir" -D COMPILER=c++ -D SANITIZE=OFF -D DOUBLE=OFF \
  -P tests/install_consumer.cmake || failed=1
worlds() {
  echo "== drape_worlds $*"
  build/release/bin/drape_worlds --jobs "$jobs" "$@" || failed=1
}
worlds --kind all --count 4000 --most-failing "$plain"
worlds --kind all --count 4000 --modifiers random --most-failing "${modified:-1}"
worlds --backend substeps --kind all --count 4000 --most-failing "$plain"
worlds --backend substeps --kind all --count 4000 --modifiers random --most-failing "${modified:-0}"
worlds --kind tiny --count 300000 --most-failing "$tiny"
worlds --kind ropes --count 2000 --most-failing "$ropes"
worlds --backend substeps --kind loads --count 2000
worlds --kind skirts --most-failing "$skirts"
worlds --backend substeps --kind skirts --most-failing "$skirts"
# Measured: 0.089 mm/s at most.
build/release/bin/rest_speeds --models "${DRAPE_MODELS_DIR:-none}" --damping 0.05 --most 0.1 || failed=1
bash tests/run_mingw.sh || failed=1
# Bullet's SoftDemo: no scene is worse with Drape.
build/release/bin/soft_demo --check --csv build/release/soft_demo.csv || failed=1
bash tests/run_sanitized.sh --full || failed=1
bash tests/run_fuzzers.sh 300 || failed=1
exit $failed
