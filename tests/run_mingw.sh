#!/usr/bin/env bash
# Builds the core and its tests for Windows with Debian's MinGW, and runs the tests of the fast tier under Wine:
# run_mingw.sh [ctest options]
#
# Installs what it needs. Wine keeps its files in build/mingw, not in the user's home.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export DRAPE_WARNINGS_AS_ERRORS=${DRAPE_WARNINGS_AS_ERRORS-ON}

bash cmake/install_packages.sh --mingw
bash cmake/build_preset.sh mingw drape_core drape_test_unit
export WINEPREFIX=$PWD/build/mingw/wine WINEDEBUG=-all WINEDLLOVERRIDES="mscoree,mshtml="
# The first program makes Wine's files, which takes longer than a test may.
wine cmd /c exit
ctest --test-dir build/mingw --output-on-failure --no-tests=error -L '^unit$' --parallel "$(nproc)" "$@"
