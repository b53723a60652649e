#!/usr/bin/env bash
# Installs the Debian 12 / Ubuntu 24.04 packages that Drape needs: install_packages.sh [--tools | --mingw]
#
# For the library and its tools with --tools; for tests/run_mingw.sh alone with --mingw; else for benchmarks, the Python
# module and tests, too.
# Calls apt only when dpkg says that something is missing, with sudo when not root. Fails, naming the packages, when
# something is missing and cannot be installed. The one list of packages.
set -euo pipefail

packages=(
  # build
  g++ cmake make ninja-build pkgconf
  # library
  libbullet-dev opencl-c-headers opencl-clhpp-headers zlib1g-dev nlohmann-json3-dev
  # an OpenCL device on any machine, and the loader
  pocl-opencl-icd ocl-icd-libopencl1
  # tools: arguments, PNG, WebP, rays, replay pages; exact arithmetic for the independent check
  libcli11-dev libpng-dev libwebp-dev libembree-dev libjs-three libgmp-dev
  # the example with a window
  libglfw3-dev libimgui-dev libgl-dev
  # data: the bunny
  glmark2-data
)
further=(
  # benchmarks: peers, plots
  libfcl-dev libtbb-dev python3-matplotlib
  # the Python module and its tests
  python3-dev pybind11-dev python3-numpy python3-pytest mypy
  # tests; a simulated GPU; a display without a screen; fuzzing; the format of C++ and OpenCL C
  libgtest-dev oclgrind xvfb libgl1-mesa-dri clang libclang-rt-dev clang-format
  # scene files against their schema; man pages; the API reference
  python3-jsonschema groff doxygen
  # published data: unpacking
  xz-utils
)
# The test of replay pages needs a browser, which Ubuntu has no package of.
grep -qs '^ID=debian$' /etc/os-release && further+=(chromium)
case ${1:-} in
  "") packages+=("${further[@]}") ;;
  --tools) ;;
  # The core for Windows: compiler, tests' sources, and what runs them.
  --mingw)
    packages=(cmake make ninja-build pkgconf g++-mingw-w64-x86-64-posix googletest nlohmann-json3-dev wine wine64)
    ;;
  *) echo "install_packages.sh: $1 is no option; --tools and --mingw are" >&2; exit 2 ;;
esac

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
