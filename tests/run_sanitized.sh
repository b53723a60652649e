#!/usr/bin/env bash
# Runs the host's tests with the address and undefined-behaviour sanitizers: run_sanitized.sh [arguments of ctest]
#
# Builds the asan preset. OpenCL drivers are left out (DRAPE_TEST_NO_DEVICE): what they do with memory is not Drape's. The
# longest worlds are left out too: they are run by run_tests.sh. tests/README.md says what and why. Published data is used
# where reference_data.sh finds it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bash cmake/install_packages.sh
bash cmake/build_preset.sh asan drape_test_unit drape_test_mesh_io drape_test_oracle drape_test_property \
  drape_test_stress drape_test_bullet drape_test_startup drape_test_tools

source tests/reference_data.sh
export DRAPE_TEST_NO_DEVICE=1
export OCL_ICD_VENDORS=/nonexistent
exec ctest --test-dir build/asan --output-on-failure --no-tests=error --parallel "$(nproc)" \
  --label-regex '^(unit|mesh_io|oracle|property|stress|bullet|startup|tools)$' \
  --exclude-regex 'TenThousandSteps|Row25|Settled|BunnyDrop|HundredThousand|DropComparison' "$@"
