#!/usr/bin/env bash
# Formats C++ and OpenCL C, or checks the format: format.sh [--check] [clang-format of version 14]
#
# Takes all files that git tracks. With --check it changes nothing, prints each difference and fails if there is one.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

action=(-i)
if [[ ${1-} == --check ]]; then
  action=(--dry-run -Werror)
  shift
fi
git -c "safe.directory=*" ls-files -z '*.h' '*.cpp' '*.cl' | xargs -0 "${1:-clang-format}" "${action[@]}"
