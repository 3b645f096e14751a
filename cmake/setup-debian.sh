#!/bin/sh
# Installs what the build, the tests and the examples need on Debian 12 and later and on Ubuntu; does nothing when all of
# it is there. Works as root or through sudo.
set -eu

packages="
build-essential cmake git ninja-build pkg-config
glslang-tools spirv-tools
libvulkan-dev libvulkan-volk-dev mesa-vulkan-drivers vulkan-validationlayers vulkan-tools
libglm-dev libopenimageio-dev openimageio-tools libassimp-dev libembree-dev
libcmocka-dev libcjson-dev
gnuplot-nox python3 abigail-tools
"

missing=
for package in $packages; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

root=
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
        echo "setup-debian.sh: as root, install:$missing" >&2
        exit 1
    fi
    root=sudo
fi
echo "Installing:$missing"
$root env DEBIAN_FRONTEND=noninteractive apt-get update -q
# shellcheck disable=SC2086 # a list of words
$root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing
