#!/usr/bin/env bash
# Builds the release preset and runs the tests: run_tests.sh [--fast] [arguments of ctest]
#
# Installs missing packages first. Runs the tiers fast and full, or fast alone; run_slow.sh runs the rest. Fails if a
# test fails or none is found. Published data is used where reference_data.sh finds it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export DRAPE_WARNINGS_AS_ERRORS=${DRAPE_WARNINGS_AS_ERRORS-ON}

tier='^(fast|full)$'
if [[ ${1-} == --fast ]]; then
  tier='^fast$'
  shift
fi
bash cmake/install_packages.sh
bash cmake/build_preset.sh release

source tests/reference_data.sh

# A -j among the arguments comes later and wins.
exec ctest --test-dir build/release --output-on-failure --no-tests=error --label-regex "$tier" \
  --parallel "$(nproc)" "$@"
