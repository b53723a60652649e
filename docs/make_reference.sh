#!/usr/bin/env bash
# Makes the API reference of the installed headers: make_reference.sh [FOLDER]
#
# Writes FOLDER/html/index.html (build/reference by default). Needs Doxygen (apt-get install doxygen). Fails on a
# warning, such as a public function without a comment.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
command -v doxygen >/dev/null || { echo "make_reference.sh: needs doxygen (apt-get install doxygen)" >&2; exit 2; }

export DRAPE_REFERENCE=${1:-build/reference}
DRAPE_VERSION=$(sed -n 's/^#define DRAPE_VERSION_STRING "\(.*\)"$/\1/p' bullet_plugin/include/drape/version.h)
export DRAPE_VERSION
mkdir -p "$DRAPE_REFERENCE"
doxygen docs/Doxyfile
echo "Reference: $DRAPE_REFERENCE/html/index.html"
