#!/usr/bin/env bash
# Runs every test: run_tests.sh [arguments of ctest]
#
# Installs missing packages, builds the release preset and runs ctest. Fails when a test fails or none is found.
# Reference data is used when an archive with an unpack.sh is there (DRAPE_DATA_ARCHIVE, its folder); without it, the
# tests that need DRAPE_TRUTH_DIR or DRAPE_MODELS_DIR say so and are skipped.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bash cmake/install_packages.sh
bash cmake/build_preset.sh release

archive=${DRAPE_DATA_ARCHIVE:-../shared}
if [[ -f $archive/unpack.sh ]]; then
  sh "$archive/unpack.sh" build/data
  export DRAPE_TRUTH_DIR=$PWD/build/data/truth DRAPE_MODELS_DIR=$PWD/build/data/models
fi

# A -j among the arguments comes later and wins.
exec ctest --test-dir build/release --output-on-failure --no-tests=error --parallel "$(nproc)" "$@"
