#!/bin/sh
# usage: errors.sh SOFTSHADOW_RENDER SOFTSHADOW_EVAL WORK_DIR
# The tools on bad input: exit status 1 (2 for a wrong command line), one line on standard error that names the file, field
# or setting, and nothing written.
set -eu
render=$1 eval=$2 work=$3
rm -rf "$work"
mkdir -p "$work"
cd "$work"
failures=0
passes=0

# expect STATUS WORDS COMMAND...: every word of WORDS stands in the one line of the message.
expect() {
    status=$1 words=$2
    shift 2
    got=0
    timeout 60 "$@" >out 2>err || got=$?
    lines=$(wc -l <err)
    ok=yes
    [ "$got" -eq "$status" ] || ok="exit status $got, expected $status"
    [ "$lines" -eq 1 ] || ok="$lines lines on standard error, expected 1"
    for word in $words; do
        grep -qF -- "$word" err || ok="\"$word\" is not in the message"
    done
    if [ "$ok" = yes ]; then
        passes=$((passes + 1))
    else
        failures=$((failures + 1))
        echo "FAILED: $*: $ok: $(head -n 3 err)"
    fi
}

"$render" --scene slab --size 64x48 --map 64 --truth 4 --technique hard --out good.png --dump good >/dev/null
"$eval" good --repeat 0 >/dev/null # the cases below are broken copies of one that works

broken() { # a copy of the case with one substitution in case.json
    rm -rf bad
    cp -r good bad
    sed "$1" good/case.json >bad/case.json
}

expect 1 "missing" "$eval" missing
expect 1 "setting primitive" "$eval" good --technique bitmask --set primitive=brick
expect 1 "unknown setting \"pattern\" for contour" "$eval" good --technique contour --set pattern=8x8
expect 1 "technique" "$eval" good --technique brick
expect 1 "budget" "$eval" good --technique bitmask --set budget=-4
expect 2 "repeat" "$eval" good --repeat x
expect 2 "case" "$eval"
expect 1 "layers" "$eval" good --set layers=3
expect 1 "embree scene" "$eval" good --technique embree
expect 1 "samples 65536" "$eval" good --technique embree --set samples=0
broken 's/"shape":[^,]*,/"shape": "cube",/'
expect 1 "case.json shape" "$eval" bad
broken 's/"depth_convention":[^,]*,/"depth_convention": "sideways",/'
expect 1 "case.json depth_convention" "$eval" bad
broken 's/"role":[^,]*,/"role": "face",/'
expect 1 "face" "$eval" bad --repeat 0
sublight() { # the two maps as parts of the light
    broken 's/"role": "layer", "index": \([01]\)/"role": "sublight", "grid": '"$1"', "cell": '"$2"'/'
}
sublight '[2, 1]' '[\1, 0]'
"$eval" bad --repeat 0 >/dev/null
expect 1 "role sublight" "$eval" bad --technique pcss
expect 1 "layers sub-lights" "$eval" bad --set layers=2
sublight '[2, 3]' '[\1, 0]'
expect 1 "maps 6 2 x 3 2" "$eval" bad
sublight '[2, 1]' '[0, 0]'
expect 1 "cell" "$eval" bad
sublight '[2, 1]' '[2, 0]'
expect 1 "cell" "$eval" bad
sublight '[\12, 1]' '[0, 0]'
expect 1 "grid" "$eval" bad
broken 's/"width":/"breadth":/'
expect 1 "case.json width" "$eval" bad
broken 's/{/[/'
expect 1 "case.json" "$eval" bad
rm -rf bad
cp -r good bad
for image in bad/*.exr; do
    head -c 200 "$image" >cut
    mv cut "$image"
done
expect 1 ".exr" "$eval" bad
expect 1 "/nowhere/x.json" "$eval" good --repeat 0 --json /nowhere/x.json

expect 2 "brick" "$render" --scene brick --out x.png
expect 2 "" "$render" --scene balls
expect 1 "missing.obj" "$render" --model missing.obj --out x.png
: >empty.obj
expect 1 "empty.obj" "$render" --model empty.obj --out x.png
printf 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n' >cut.ply
expect 1 "cut.ply" "$render" --model cut.ply --out x.png
printf 'v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n' >nan.obj
expect 1 "nan.obj" "$render" --model nan.obj --out x.png
expect 1 "/nowhere/x.png" "$render" --scene slab --size 64x48 --map 64 --out /nowhere/x.png
expect 2 "size" "$render" --scene slab --size 0x48 --out x.png
if [ -e x.png ]; then
    failures=$((failures + 1))
    echo "FAILED: a failed command wrote x.png"
fi

echo "$passes passed, $failures failed"
[ "$failures" -eq 0 ]
