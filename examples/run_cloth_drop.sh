#!/usr/bin/env bash
# Drops a cloth on a mesh: run_cloth_drop.sh [arguments of cloth_drop]
#
# Installs missing packages, builds cloth_drop and runs it with the arguments given; on the Stanford bunny when there
# is no --obstacle. File names are relative to the folder that the script is called from.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
bunny=/usr/share/glmark2/models/bunny.obj

bash "$root/cmake/install_packages.sh" --tools
(cd "$root" && bash cmake/build_preset.sh release cloth_drop)

obstacle=(--obstacle "$bunny")
for argument in "$@"; do
  case $argument in
    --obstacle | --obstacle=*) obstacle=() ;;
  esac
done
exec "$root/build/release/bin/cloth_drop" "${obstacle[@]}" "$@"
