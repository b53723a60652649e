#!/usr/bin/env bash
# Runs every test: run_tests.sh [arguments of ctest]
#
# Installs missing packages, builds the release preset and runs ctest. Fails when a test fails or none is found.
# Published data is used where reference_data.sh finds it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bash cmake/install_packages.sh
bash cmake/build_preset.sh release

source tests/reference_data.sh

# A later -j among the arguments wins.
exec ctest --test-dir build/release --output-on-failure --no-tests=error --parallel "$(nproc)" "$@"
