#!/bin/sh
# usage: docs/images/make.sh BUILD_DIR [MODEL]
# Renders the pictures of the documents again, next to this script. Needs softshadow-render in BUILD_DIR and oiiotool.
#
#   balls.png       the scene `balls` with technique auto
#   techniques.png  one crop of it: hard, pcss, auto, ray-traced
#   thin.png        the shadow of the scene `twigs`: ray-traced, contours with a budget of 8, the same without refinement
#   model.png       MODEL with auto, and ray-traced; left alone if no model is given. The one kept here is the Khronos
#                   glTF sample asset FlightHelmet (CC0)
#
# RAYS (1024 per pixel of the ray-traced pictures) may be set in the environment.
set -eu

if [ $# -lt 1 ] || [ $# -gt 2 ]; then
    sed -n '2s/^# //p' "$0" >&2
    exit 2
fi
images=$(cd "$(dirname "$0")" && pwd)
render=$1/examples/softshadow-render
if [ ! -x "$render" ]; then
    echo "make.sh: no $render: build the examples first" >&2
    exit 1
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$render" --scene balls --out "$work/balls.png"
cp "$work/balls.png" "$images/balls.png"

crop=330x300+190+420
for technique in hard pcss auto; do
    "$render" --scene balls --size 1280x960 --technique $technique --out "$work/$technique.png"
    oiiotool "$work/$technique.png" --cut $crop -o "$work/$technique.png"
done
"$render" --scene balls --size 1280x960 --out "$work/last.png" --truth "${RAYS:-1024}"
oiiotool "$work/last-truth.png" --cut $crop -o "$work/truth.png"
oiiotool "$work/hard.png" "$work/pcss.png" "$work/auto.png" "$work/truth.png" --mosaic:pad=6 4x1 \
    -o "$images/techniques.png"

crop=390x195+195+240
"$render" --scene twigs --size 720x540 --out "$work/thin.png" --truth "${RAYS:-1024}"
"$render" --scene twigs --size 720x540 --technique contour --set budget=8 --out "$work/refined.png"
"$render" --scene twigs --size 720x540 --technique contour --set budget=8 --set refine=off --out "$work/coarse.png"
for picture in thin-truth refined coarse; do
    oiiotool "$work/$picture.png" --cut $crop -o "$work/$picture.png"
done
oiiotool "$work/thin-truth.png" "$work/refined.png" "$work/coarse.png" --mosaic:pad=6 3x1 -o "$images/thin.png"

if [ $# -eq 2 ]; then
    crop=560x680+430+100
    "$render" --model "$2" --size 1280x960 --out "$work/model.png" --truth "${RAYS:-1024}"
    for picture in model model-truth; do
        oiiotool "$work/$picture.png" --cut $crop -o "$work/$picture.png"
    done
    oiiotool "$work/model.png" "$work/model-truth.png" --mosaic:pad=6 2x1 -o "$images/model.png"
fi
