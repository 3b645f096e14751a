#!/bin/sh
# The figures of the papers that the library can be held against, one section each:
#     bench/figures.sh [BUILD_DIR]
# build: time and memory of HSM, MSSM and YSM over the map's size; order: errors of patterns, primitives, layers and the post
# filter; lit: what a scene without shadow costs against a pass that reads depth and writes visibility.
set -eu
cd "$(dirname "$0")/.."
build=${1:-build/ci}
work=$build/figures
mkdir -p "$work"

make_case() { # name, scene, size, map, further options
    name=$1 scene=$2 size=$3 map=$4
    shift 4
    [ -f "$work/$name/case.json" ] || "$build/examples/softshadow-render" --scene "$scene" --size "$size" --map "$map" \
        --technique hard --out "$work/$name.png" --dump "$work/$name" "$@" >/dev/null
}
evaluate() { # case, options
    name=$1
    shift
    "$build/bench/softshadow-eval" "$work/$name" --json "$work/row.json" "$@" >"$work/line.txt"
}
field() { # the first number of that name in the last row
    sed -n "s/.*\"$1\":[[:space:]]*\([0-9.e+-]*\).*/\1/p" "$work/row.json" | head -n 1
}

echo "build: milliseconds and MiB (hierarchy and fan depth)"
printf '%6s %9s %9s %9s %11s %10s %10s %10s %10s\n' map HSM YSM MSSM MSSM/HSM YSM/HSM 'HSM MiB' 'YSM MiB' 'MSSM MiB'
for map in 256 512 1024 2048; do
    make_case "balls-$map" balls 320x240 "$map"
    for accel in hsm ysm mssm; do
        evaluate "balls-$map" --technique bitmask --set accel=$accel --set budget=8 --set layers=1 --repeat 9
        eval "t_$accel=$(field build) m_$accel=$(field persistent)"
    done
    awk -v m="$map" -v h="$t_hsm" -v y="$t_ysm" -v s="$t_mssm" -v mh="$m_hsm" -v my="$m_ysm" -v ms="$m_mssm" 'BEGIN {
        printf "%6d %9.2f %9.2f %9.2f %11.2f %10.2f %10.2f %10.2f %10.2f\n", m, h, y, s, s / h, y / h,
            mh / 1048576, my / 1048576, ms / 1048576 }'
done

echo
echo "order: mean absolute error"
for scene in silhouette balls; do
    make_case "$scene" $scene 640x480 512 --truth 256
    for settings in "pattern=8x8" "pattern=16x16" "pattern=16x16j" "pattern=32x32" "primitive=microquad-rectangle" \
        "primitive=micropatch" "primitive=micropatch filter=5" "primitive=micropatch layers=2" \
        "primitive=micropatch layers=2 merge=max" "layers=2" "layers=2 merge=max"; do
        set --
        case $settings in *layers*) ;; *) set -- --set layers=1 ;; esac
        for s in $settings; do set -- "$@" --set "$s"; done
        evaluate $scene --technique bitmask --repeat 0 "$@"
        printf '%-12s bitmask %-42s %s\n' $scene "$settings" "$(field mae)"
    done
    for settings in "layers=1" "layers=1 primitive=micropatch" "layers=2 merge=max"; do
        set --
        for s in $settings; do set -- "$@" --set "$s"; done
        evaluate $scene --technique area --repeat 0 "$@"
        printf '%-12s area    %-42s %s\n' $scene "$settings" "$(field mae)"
    done
done

echo
echo "lit: 1280 x 1024 pixels, map of 1024 x 1024 texels"
make_case lit lit 1280x1024 1024
for i in 1 2 3; do
    evaluate lit --set layers=1 --against copy --repeat 41
    head -n 1 "$work/line.txt"
done
