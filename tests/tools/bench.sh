#!/bin/sh
# usage: bench.sh SOFTSHADOW_BENCH SOURCE_DIR WORK_DIR
# softshadow-bench writes valid files, keeps its rows when interrupted and finds bad input before it starts; the script that
# writes the report takes what it wrote.
set -eu
bench=$1 source=$2 work=$3
rm -rf "$work"
mkdir -p "$work"
cd "$work"
failures=0
passes=0

result() { # ok or what is wrong, what was tried
    if [ "$1" = ok ]; then
        passes=$((passes + 1))
    else
        failures=$((failures + 1))
        echo "FAILED: $2: $1"
    fi
}

# check COMMAND...: succeeds.
check() {
    if "$@" >out 2>&1; then result ok "$*"; else result "$(head -n 3 out)" "$*"; fi
}

# expect STATUS WORDS COMMAND...: every word of WORDS stands in the one line of the message.
expect() {
    status=$1 words=$2
    shift 2
    got=0
    timeout 60 "$@" >out 2>err || got=$?
    ok=ok
    [ "$got" -eq "$status" ] || ok="exit status $got, expected $status"
    [ "$(wc -l <err)" -eq 1 ] || ok="$(wc -l <err) lines on standard error, expected 1"
    for word in $words; do
        grep -qF -- "$word" err || ok="\"$word\" is not in the message"
    done
    [ "$ok" = ok ] || ok="$ok: $(head -n 3 err)"
    result "$ok" "$*"
}

# json FILE CONDITION: of the report `r`.
json() {
    python3 -c "import json, sys; r = json.load(open('$1')); sys.exit(0 if $2 else '$1: not ' + '''$2''')"
}

# lines FILE NUMBER PATTERN: so many lines match.
lines() {
    [ "$(grep -c -- "$3" "$1")" -eq "$2" ]
}

# picture FILE: a PNG that is not next to nothing.
picture() {
    head -c 4 "$1" | grep -q PNG && [ "$(wc -c <"$1")" -gt 2000 ]
}

# images FOLDER NAME...: an SVG that parses and a PNG.
images() {
    folder=$1
    shift
    for name in "$@"; do
        check python3 -c "import sys, xml.dom.minidom as x; x.parse(sys.argv[1]).getElementsByTagName('path')[9]" \
            "$folder/$name.svg"
        check picture "$folder/$name.png"
    done
}

small="--size 64x48 --map 64 --cache cache"

# A whole run, and the report from it.
mkdir report
# shellcheck disable=SC2086 # a list of words
check timeout 60 "$bench" pareto --quick $small --scene slab --technique hard --technique pcss --technique auto \
    --technique bitmask --set budget=8 --set layers=1 --json report/run.json --csv report/run.csv --plots report/plots \
    --images report/images
check json report/run.json "r['complete'] and r['quick'] and len(r['rows']) == 4 and r['figures']"
check json report/run.json "all(row['error']['mae'] > 0 and row['time_ms']['total'] > 0 for row in r['rows'])"
check json report/run.json "any(row['front'] for row in r['rows'])"
check lines report/run.csv 5 .
images report/plots pareto-slab-64x48
check test -s report/images/pareto-slab-64-auto-error.png
check "$source/docs/benchmarks.py" report/run.json --out written
check grep -q "^| PCSS |" written/docs/benchmarks.md
check grep -q "^| PCSS |" written/README.md
sed -n 's/^!\[.*\](\(images[^)]*\))$/\1/p' written/docs/benchmarks.md >shown
while read -r image; do
    check test -s "written/docs/$image"
done <shown
check lines written/docs/benchmarks.md 3 '^!\[' # plot, pictures, the worst

# Interrupted after the first rows: they are kept, plotted, and make a report.
mkdir interrupted
# shellcheck disable=SC2086
timeout -s KILL 60 "$bench" light-size --scene slab $small --technique copy --technique hard --json interrupted/run.json \
    --plots interrupted/plots >out 2>err &
job=$!
tries=0
until grep -q '"technique"' interrupted/run.json 2>/dev/null || [ $tries -gt 400 ]; do
    sleep 0.05
    tries=$((tries + 1))
done
pid=$(cat "/proc/$job/task/$job/children") # timeout is the job, the benchmark its child
# shellcheck disable=SC2086
kill -INT $pid
got=0
wait $job || got=$?
result "$([ $got -eq 130 ] && echo ok || echo "exit status $got, expected 130")" "interrupt"
check grep -q "interrupted" err
check json interrupted/run.json "r['complete'] is False and 2 <= len(r['rows']) < 16"
images interrupted/plots light-size-slab
check "$source/docs/benchmarks.py" interrupted/run.json --out partly-written
check grep -q "was interrupted" partly-written/docs/benchmarks.md

# Found before anything is measured.
expect 2 "brick pareto light-size seeds all" "$bench" brick
expect 2 "suite pareto all" "$bench"
expect 2 "brick bitmask auto pcss" "$bench" pareto --technique brick
expect 2 "brick budget primitive" "$bench" pareto --technique bitmask --set brick=1
expect 2 "brick micropatch microquad" "$bench" pareto --technique bitmask --set primitive=brick
expect 2 "--set" "$bench" pareto --set budget=1
expect 1 "brick" "$bench" pareto --scene brick --cache cache
expect 1 "nowhere.obj" "$bench" pareto --model nowhere.obj --cache cache
: >file
expect 1 "/nowhere/x.json" "$bench" pareto --json /nowhere/x.json
expect 1 "/nowhere/x.csv" "$bench" pareto --csv /nowhere/x.csv
expect 1 "file/plots" "$bench" pareto --plots file/plots
expect 1 "file/images" "$bench" pareto --images file/images
expect 1 "gnuplot" env PATH=/nowhere "$bench" pareto --plots plots
expect 1 "missing.json" "$source/docs/benchmarks.py" missing.json --out written
echo '{"rows": []}' >empty.json
expect 1 "empty.json" "$source/docs/benchmarks.py" empty.json --out written
expect 1 "file" "$source/docs/benchmarks.py" file --out written
expect 1 "softshadow-bench" "$source/docs/make_benchmarks.sh" .
expect 2 "BUILD_DIR" "$source/docs/make_benchmarks.sh"

echo "$passes passed, $failures failed"
[ "$failures" -eq 0 ]
