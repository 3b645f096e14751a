#!/bin/sh
# usage: docs/update_tables.sh BUILD_DIR
# Measures error and time of every technique on three scenes and writes the tables in README.md and docs/benchmarks.md.
# Needs softshadow-render and softshadow-eval in BUILD_DIR; cases and JSON rows are left in BUILD_DIR/tables.
#
# SIZE (640x480 pixels), RAYS (256 per pixel of the ray-traced truth), REPEAT (5 timed runs) and DEVICE (as --device of
# the tools) may be set in the environment.
set -eu

case ${1:-} in
-h | --help)
    sed -n '2,7s/^# \{0,1\}//p' "$0"
    exit 0
    ;;
esac
if [ $# -ne 1 ]; then
    echo "usage: docs/update_tables.sh BUILD_DIR" >&2
    exit 2
fi
build=$(cd "$1" && pwd)
cd "$(dirname "$0")/.."
render=$build/examples/softshadow-render
eval_case=$build/bench/softshadow-eval
for program in "$render" "$eval_case"; do
    if [ ! -x "$program" ]; then
        echo "update_tables.sh: no $program: build the examples and the benchmark first" >&2
        exit 1
    fi
done
for document in README.md docs/benchmarks.md; do
    for marker in begin end; do
        if ! grep -q "^<!-- table:$marker -->\$" "$document"; then
            echo "update_tables.sh: $document has no line <!-- table:$marker -->" >&2
            exit 1
        fi
    done
done

scenes="balls fence slab"
# Name in the tables | arguments of softshadow-eval.
techniques="hard|--technique hard
PCF|--technique pcf
PCSS|--technique pcss
area, micropatches|--technique area --set primitive=micropatch
bitmask, micropatches|--technique bitmask --set primitive=micropatch
bitmask, microquad rectangles|--technique bitmask --set primitive=microquad-rectangle
bitmask, microquads|--technique bitmask --set primitive=microquad
bitmask, microquads, budget 32|--technique bitmask --set primitive=microquad --set budget=32
bitmask, microquads, budget 16|--technique bitmask --set primitive=microquad --set budget=16
bitmask, micropatches, budget 32|--technique bitmask --set primitive=micropatch --set budget=32
bitmask, micropatches, budget 16|--technique bitmask --set primitive=micropatch --set budget=16
auto, first layer only|--technique auto --set layers=1
auto|--technique auto"

work=$build/tables
mkdir -p "$work"

# number FILE KEY: the value of the first "KEY" in a row, empty for null.
number()
{
    tr -d ' \t\n' <"$1" | grep -o "\"$2\":[^,}]*" | head -n 1 | sed 's/^[^:]*://; s/^null$//'
}

# text FILE KEY
text()
{
    sed -n "s/^[[:space:]]*\"$2\":[[:space:]]*\"\(.*\)\",\{0,1\}\$/\1/p" "$1" | head -n 1
}

# round NUMBER DIGITS
round()
{
    case $1 in
    '') printf '–' ;;
    *) LC_ALL=C printf "%.$2f" "$1" ;;
    esac
}

# row_file SCENE NAME: where a row's JSON is.
row_file()
{
    echo "$work/$1-$(echo "$2" | tr -d ',' | tr ' ' '-').json"
}

# each COMMAND: runs COMMAND NAME ARGUMENTS... for every technique.
each()
{
    echo "$techniques" | while IFS='|' read -r name arguments; do
        # shellcheck disable=SC2086 # a list of words
        "$1" "$name" $arguments </dev/null
    done
}

measure()
{
    name=$1
    shift
    # shellcheck disable=SC2086 # nothing, or an option
    "$eval_case" "$work/$scene" "$@" ${DEVICE:+--device "$DEVICE"} --repeat "${REPEAT:-5}" --json "$(row_file "$scene" "$name")"
}

for scene in $scenes; do
    echo "$scene: rendering, and tracing ${RAYS:-256} rays per pixel"
    rm -rf "${work:?}/$scene"
    "$render" --scene "$scene" --size "${SIZE:-640x480}" --technique hard --out "$work/$scene.png" --dump "$work/$scene" \
        --truth "${RAYS:-256}" ${DEVICE:+--device "$DEVICE"} >/dev/null
    each measure
done

# What was measured, in one sentence.
conditions()
{
    first=$(row_file balls hard)
    printf '%s, %s; %s x %s pixels, truth of %s rays per pixel, medians of %s runs.\n' "$(text "$first" device)" \
        "$(text "$first" driver)" "$(number "$first" width)" "$(number "$first" height)" "${RAYS:-256}" "${REPEAT:-5}"
}

short_row()
{
    line="| $1 |"
    for scene in $scenes; do
        file=$(row_file "$scene" "$1")
        total=$(number "$file" total) hierarchy=$(number "$file" build)
        time=$(round "$(awk "BEGIN { print ${total:-0} - ${hierarchy:-0} }")" 1)
        line="$line $(round "$(number "$file" mae)" 3) | $time${hierarchy:+ + $(round "$hierarchy" 1)} |"
    done
    echo "$line"
}

short_table()
{
    conditions
    echo
    echo "| technique | balls: error | ms + build | fence: error | ms + build | slab: error | ms + build |"
    echo "|---|---|---|---|---|---|---|"
    each short_row
}

long_row()
{
    file=$(row_file "$scene" "$1")
    line="| $1 | $(round "$(number "$file" mae)" 4) | $(round "$(number "$file" rmse)" 4) | $(round "$(number "$file" p99)" 3) |"
    for key in build classify evaluate total; do
        line="$line $(round "$(number "$file" $key)" 2) |"
    done
    echo "$line $(round "$(number "$file" active)" 0) | $(round "$(number "$file" primitives_per_active)" 0) |"
}

long_tables()
{
    conditions
    for scene in $scenes; do
        file=$(row_file "$scene" auto)
        echo
        LC_ALL=C printf '**%s**, map %s², light %g wide; auto takes %.1f MiB for the light and %.1f MiB of scratch\n' "$scene" \
            "$(number "$file" map_size)" "$(number "$file" light_size)" \
            "$(awk "BEGIN { print $(number "$file" persistent) / 1048576 }")" \
            "$(awk "BEGIN { print $(number "$file" transient) / 1048576 }")"
        echo
        echo "| technique | error | rms | 99 % | build ms | classify ms | evaluate ms | total ms | active pixels | primitives each |"
        echo "|---|---|---|---|---|---|---|---|---|---|"
        each long_row
    done
}

# replace DOCUMENT FILE: what lies between the markers.
replace()
{
    awk -v file="$2" '
        /^<!-- table:end -->$/ { inside = 0 }
        !inside { print }
        /^<!-- table:begin -->$/ { inside = 1; while ((getline line < file) > 0) print line }
    ' "$1" >"$work/document"
    cat "$work/document" >"$1"
}

short_table >"$work/short.md"
long_tables >"$work/long.md"
replace README.md "$work/short.md"
replace docs/benchmarks.md "$work/long.md"
echo "README.md and docs/benchmarks.md have the new tables."
