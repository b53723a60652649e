#!/usr/bin/env bash
# Runs the host's tests with the address and undefined-behaviour sanitizers: run_sanitized.sh [--full] [arguments of
# ctest]
#
# Builds the asan preset and runs the fast tier, with --full also the full tier without its longest worlds. Uses no
# OpenCL driver (DRAPE_TEST_NO_DEVICE), since Drape cannot answer for a driver's memory. tests/README.md says more.
# Published data is used where reference_data.sh finds it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export DRAPE_WARNINGS_AS_ERRORS=${DRAPE_WARNINGS_AS_ERRORS-ON}

tier='^fast$'
if [[ ${1-} == --full ]]; then
  tier='^(fast|full)$'
  shift
fi
groups=(unit mesh_io oracle property stress bullet cloth_world process startup tools)
bash cmake/install_packages.sh
bash cmake/build_preset.sh asan "${groups[@]/#/drape_test_}"

source tests/reference_data.sh
export DRAPE_TEST_NO_DEVICE=1
export OCL_ICD_VENDORS=/nonexistent
# Two label expressions: both must match.
exec ctest --test-dir build/asan --output-on-failure --no-tests=error --parallel "$(nproc)" \
  --label-regex "$tier" --label-regex "^($(IFS='|'; echo "${groups[*]}"))\$" \
  --exclude-regex 'BunnyDrop|Settled|RopesDropped|DropComparison' "$@"
