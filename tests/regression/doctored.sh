#!/bin/sh
# usage: doctored.sh REGRESSION WORK_DIR
# The check of the bounds can fail: on copies of good bounds with one thing changed it names that and nothing else, and on
# what is no file of bounds it says so in one line.
set -eu
program=$1 work=$2
rm -rf "$work"
mkdir -p "$work"
cd "$work"
failures=0
passes=0

fail() {
    failures=$((failures + 1))
    echo "FAILED: $*"
    cat out err
}

regression() { # FILE TECHNIQUE OPTION...
    file=$1 technique=$2
    shift 2
    timeout 120 "$program" "$file" --scene slab --technique "$technique" --cache truth "$@" >out 2>err
}

# moved TECHNIQUE WORDS SCRIPT: with the bounds edited by sed SCRIPT one figure fails, and its line starts with WORDS.
moved() {
    technique=$1
    shift
    sed "$2" good.json >doctored.json
    cmp -s good.json doctored.json && fail "$2 changed nothing" && return
    got=0
    regression doctored.json "$technique" || got=$?
    lines=$(grep -c '^[a-z]*: ' err || true)
    if [ "$got" -eq 1 ] && [ "$lines" -eq 1 ] && grep -q "^$1" err && grep -q '^1 of .* moved' err; then
        passes=$((passes + 1))
    else
        fail "$2: exit status $got, expected one line starting with \"$1\""
    fi
}

# refused STATUS WORD COMMAND...: one line with WORD on standard error.
refused() {
    status=$1 word=$2 got=0
    shift 2
    timeout 60 "$@" >out 2>err || got=$?
    if [ "$got" -eq "$status" ] && [ "$(wc -l <err)" -eq 1 ] && grep -qF -- "$word" err; then
        passes=$((passes + 1))
    else
        fail "$*: exit status $got, expected $status and one line with \"$word\""
    fi
}

if regression good.json auto --update && regression good.json hard --update && regression good.json auto &&
    regression good.json hard; then
    passes=$((passes + 1))
else
    fail "bounds as just written"
fi

hard='/"hard"/,/}/' # hard is quick and has no counts but one; auto has all
moved auto 'slab: auto: active is [0-9]*, bounds' '/"active"/s/\[/[1/'
moved hard 'slab: hard: error_pixels is [0-9]*, bounds' "$hard"'s/"error_pixels": \[/&1/'
moved hard 'slab: hard: mae is .*, bounds' "$hard"'s/"mae": \[[0-9.]*/"mae": [0.9/' # better than its bounds
moved hard 'slab: hard: mae is .* and has no bounds' "$hard"'{/"mae"/d;}'
moved hard 'slab: hard: brick has bounds' 's/"hard": {/&"brick": [1, 0], /'
moved hard 'slab: brick: mae has bounds' 's/"slab": {/&"brick": {"mae": [1, 0]}, /'
moved hard 'brick: hard: mae has bounds' 's/"scenes": {/&"brick": {"hard": {"mae": [1, 0]}}, /'

sed "$hard"'s/"error_pixels": \[/&1/' good.json >updated.json
if regression updated.json hard --update && cmp -s good.json updated.json && grep -q '1 had moved' out; then
    passes=$((passes + 1))
else
    fail "an update of doctored bounds"
fi

refused 1 "missing.json" "$program" missing.json
refused 1 "cut.json: not JSON, at line" sh -c 'head -n 9 good.json >cut.json; exec "$0" cut.json' "$program"
: >empty.json
refused 1 "empty.json: not JSON" "$program" empty.json
echo '{}' >object.json
refused 1 "object.json: scenes" "$program" object.json
sed '/"active"/s/\[[^]]*\]/"many"/' good.json >shape.json
refused 1 "shape.json: slab: auto: active" "$program" shape.json
sed '/"active"/s/, [0-9]*\]/, -1]/' good.json >negative.json
refused 1 "negative.json: slab: auto: active" "$program" negative.json
sed 's/"active"/"mae": [1, 0], &/' good.json >twice.json
refused 1 "twice.json: slab: auto: mae" "$program" twice.json
refused 1 "shape.json: slab: auto: active" "$program" shape.json --update --scene slab
refused 1 "/nowhere/bounds.json" "$program" /nowhere/bounds.json --update
refused 2 "brick" "$program" good.json --scene brick
refused 2 "brick" "$program" good.json --technique brick
refused 2 "file" "$program"

echo "$passes passed, $failures failed"
[ "$failures" -eq 0 ]
