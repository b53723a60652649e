#!/usr/bin/env bash
# Installs the Debian 12 / Ubuntu 24.04 packages that Drape needs: install_packages.sh [--tools]
#
# For the library and its tools with --tools; else for benchmarks and tests, too.
# Calls apt only when dpkg says that something is missing, with sudo when not root. Fails, naming the packages, when
# something is missing and cannot be installed. The one list of packages.
set -euo pipefail

packages=(
  # build
  g++ cmake make ninja-build pkgconf
  # library
  libbullet-dev opencl-c-headers opencl-clhpp-headers
  # an OpenCL device on any machine, and the loader
  pocl-opencl-icd ocl-icd-libopencl1
  # tools: arguments, JSON, PNG, rays; exact arithmetic for the independent check
  libcli11-dev nlohmann-json3-dev libpng-dev libembree-dev libgmp-dev
  # data: the bunny
  glmark2-data
)
further=(
  # benchmarks: peers, plots
  libfcl-dev libtbb-dev python3-matplotlib
  # tests; a simulated GPU; fuzzing; the format of C++ and OpenCL C
  libgtest-dev oclgrind clang libclang-rt-dev clang-format
  # published data: unpacking
  xz-utils
)
[[ ${1:-} == --tools ]] || packages+=("${further[@]}")

if ! command -v dpkg-query >/dev/null; then
  echo "No dpkg here: cannot check for these packages (Debian names): ${packages[*]}" >&2
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $status == installed* ]] || missing+=("$package")
done
[[ ${#missing[@]} -gt 0 ]] || exit 0

as_root=()
if [[ $(id -u) != 0 ]]; then
  # sudo works without a password, or can ask for one.
  if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [[ -t 0 ]]; }; then
    as_root=(sudo)
  else
    echo "These packages are missing and need root or sudo to install:" >&2
    echo "  apt-get install ${missing[*]}" >&2
    exit 1
  fi
fi

echo "Installing ${missing[*]}" >&2
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300)
# An update that fails for one source may still be good enough: let the installation decide.
"${apt[@]}" update -q >&2 || echo "apt-get update failed; trying with the lists that are there" >&2
if ! "${apt[@]}" install -q -y --no-install-recommends "${missing[@]}" >&2; then
  echo "Could not install: ${missing[*]}" >&2
  exit 1
fi
