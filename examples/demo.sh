#!/bin/sh
# usage: examples/demo.sh [MODEL]
# Installs what is missing, builds, renders the scene `balls` and MODEL (or the scene `contact`), writes pictures and error
# maps to out/demo, and prints what each technique's shadows cost and how far they are from ray-traced ones.
#
# SIZE (640x480), MAP (1024), RAYS (256 per pixel of the ray-traced truth) and REPEAT (3 timed runs) may be set in the
# environment.
set -eu

case ${1:-} in
-h | --help)
    sed -n '2,7s/^# \{0,1\}//p' "$0"
    exit 0
    ;;
esac
if [ $# -gt 1 ]; then
    echo "usage: examples/demo.sh [MODEL]" >&2
    exit 2
fi
if [ $# -eq 1 ] && [ ! -r "$1" ]; then
    echo "demo.sh: cannot read the model '$1'" >&2
    exit 1
fi
model=${1:+$(realpath "$1")}
cd "$(dirname "$0")/.."
if command -v apt-get >/dev/null; then
    cmake/setup-debian.sh
fi

build=build/demo
out=out/demo
mkdir -p "$out"
echo "Building into $build (output in $out/build.log)"
if ! { cmake --preset default -B "$build" -DSOFTSHADOW_BUILD_TESTS=OFF &&
    cmake --build "$build" --parallel "$(nproc 2>/dev/null || echo 2)"; } >"$out/build.log" 2>&1; then
    tail -n 30 "$out/build.log" >&2
    echo "demo.sh: the build failed" >&2
    exit 1
fi

program()
{
    find "$build" -type f -name "$1" -perm -u+x | head -n 1
}
render=$(program softshadow-render)
eval_case=$(program softshadow-eval)
if [ -z "$render" ] || [ -z "$eval_case" ]; then
    echo "demo.sh: softshadow-render and softshadow-eval were not built" >&2
    exit 1
fi

# number FILE KEY: the value of the first "KEY" in a JSON file, or "-" for null.
number()
{
    tr -d ' \t\n' <"$1" | grep -o "\"$2\":[^,}]*" | head -n 1 | sed 's/^[^:]*://; s/^null$/-/'
}

# round NUMBER DIGITS
round()
{
    case $1 in
    '' | -) echo - ;;
    *) LC_ALL=C printf "%.$2f" "$1" ;;
    esac
}

# evaluate CASE_DIR LABEL ARGUMENTS...: one row of the table.
evaluate()
{
    folder=$1
    label=$2
    shift 2
    json=$folder/$label.json
    "$eval_case" "$folder" "$@" --repeat "${REPEAT:-3}" --out "$folder/$label" --json "$json" >/dev/null
    printf '%-34s %10s %10s %12s\n' "$label" "$(round "$(number "$json" mae)" 4)" "$(round "$(number "$json" p99)" 3)" \
        "$(round "$(number "$json" total)" 2)"
}

# show NAME ARGUMENTS...: pictures, a case with ray-traced truth, and its table.
show()
{
    name=$1
    shift
    echo
    echo "$name: rendering, and tracing ${RAYS:-256} rays per pixel for the truth"
    for technique in hard pcss auto; do
        "$render" "$@" --technique "$technique" --size "${SIZE:-640x480}" --map "${MAP:-1024}" \
            --out "$out/$name-$technique.png" >/dev/null
    done
    "$render" "$@" --size "${SIZE:-640x480}" --map "${MAP:-1024}" --out "$out/$name.png" --dump "$out/$name" \
        --truth "${RAYS:-256}" >/dev/null
    printf '%-34s %10s %10s %12s\n' "technique" "mean error" "99 %" "milliseconds"
    evaluate "$out/$name" hard --technique hard
    evaluate "$out/$name" pcss --technique pcss
    evaluate "$out/$name" bitmask --technique bitmask
    evaluate "$out/$name" bitmask-budget-32 --technique bitmask --set budget=32
    evaluate "$out/$name" bitmask-budget-16 --technique bitmask --set budget=16
    evaluate "$out/$name" bitmask-budget-8 --technique bitmask --set budget=8
    evaluate "$out/$name" bitmask-micropatch --technique bitmask --set primitive=micropatch
    evaluate "$out/$name" bitmask-8x8 --technique bitmask --set pattern=8x8
    evaluate "$out/$name" auto --technique auto
}

show balls --scene balls
if [ -n "$model" ]; then
    name=$(basename "$model")
    show "${name%.*}" --model "$model"
else
    show contact --scene contact
fi
echo
echo "Pictures: $out/*.png. Results and error maps: $out/*/*/."
