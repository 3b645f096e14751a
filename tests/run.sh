#!/bin/sh
# Everything from a fresh clone: installs missing packages (Debian, Ubuntu), builds with warnings as errors, runs every
# test. A machine without a Vulkan device fails; nothing is skipped. The software driver will do.
set -eu
cd "$(dirname "$0")/.."

if command -v apt-get >/dev/null; then
    cmake/setup-debian.sh
fi
jobs=$(nproc 2>/dev/null || echo 2)
export CMAKE_GENERATOR="${CMAKE_GENERATOR:-Ninja}"

if ! vulkaninfo --summary >/dev/null 2>&1; then
    echo "tests/run.sh: no Vulkan device; install one, mesa-vulkan-drivers has a software driver" >&2
    exit 1
fi
cmake --preset ci
cmake --build --preset ci --parallel "$jobs"
ctest --preset ci "$@"
