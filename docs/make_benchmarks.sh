#!/bin/sh
# usage: docs/make_benchmarks.sh BUILD_DIR [MODEL]
# Runs every suite of softshadow-bench and writes docs/benchmarks.md, docs/images/benchmarks and the table of README.md.
# Needs softshadow-bench in BUILD_DIR, gnuplot, python3 and oiiotool; what was measured stays in BUILD_DIR/benchmarks.
#
#   MODEL   a mesh file, which becomes one more case of the suite `pareto`
#
# QUICK=1 (small and short), DEVICE (as --device of the tools) and OUT (a folder in place of this repository) may be set in
# the environment.
set -eu

case ${1:-} in
-h | --help)
    sed -n '2,9s/^# \{0,1\}//p' "$0"
    exit 0
    ;;
esac
if [ $# -lt 1 ] || [ $# -gt 2 ]; then
    sed -n '2s/^# //p' "$0" >&2
    exit 2
fi
docs=$(cd "$(dirname "$0")" && pwd)
bench=$1/bench/softshadow-bench
if [ ! -x "$bench" ]; then
    echo "make_benchmarks.sh: no $bench: build the benchmark first" >&2
    exit 1
fi
for program in gnuplot python3 oiiotool; do
    if ! command -v $program >/dev/null; then
        echo "make_benchmarks.sh: no $program: cmake/setup-debian.sh installs it" >&2
        exit 1
    fi
done
if [ $# -eq 2 ] && [ ! -f "$2" ]; then
    echo "make_benchmarks.sh: $2: no such file" >&2
    exit 1
fi

work=$1/benchmarks
rm -rf "$work/plots" "$work/images" # of suites and techniques that are no more
mkdir -p "$work"

measure() { # suite, name of the files, further options
    suite=$1 name=$2
    shift 2
    "$bench" "$suite" ${QUICK:+--quick} ${DEVICE:+--device "$DEVICE"} --json "$work/$name.json" --csv "$work/$name.csv" \
        --plots "$work/plots" --images "$work/images" "$@"
}

measure all all
set -- "$work/all.json" ${2:+"$2"}
if [ $# -eq 2 ]; then
    measure pareto model --model "$2"
    set -- "$1" "$work/model.json"
fi
"$docs/benchmarks.py" "$@" ${OUT:+--out "$OUT"}
