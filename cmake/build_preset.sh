#!/usr/bin/env bash
# Configures and builds a preset: build_preset.sh preset [target…]. Everything when no target is named.
#
# Run from the repository's root. Ninja when it is there, make otherwise; an existing build folder keeps what it has.
# DRAPE_WARNINGS_AS_ERRORS (ON or OFF) in the environment sets the option of that name.
# What the tools print goes to standard error, so that a caller's standard output stays its own.
set -euo pipefail

preset=$1
shift
if [[ -z ${CMAKE_GENERATOR:-} ]]; then
  if command -v ninja >/dev/null; then
    export CMAKE_GENERATOR=Ninja
  else
    export CMAKE_GENERATOR="Unix Makefiles"
  fi
fi
options=()
[[ -z ${DRAPE_WARNINGS_AS_ERRORS:-} ]] || options+=(-D "DRAPE_WARNINGS_AS_ERRORS=$DRAPE_WARNINGS_AS_ERRORS")
cmake --preset "$preset" "${options[@]}" >&2
targets=()
[[ $# == 0 ]] || targets=(--target "$@")
cmake --build --preset "$preset" --parallel "$(nproc)" "${targets[@]}" >&2
