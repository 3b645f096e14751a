#!/bin/sh
# usage: run.sh BUILD_DIR WORK_DIR VERSION
# Installs into a prefix, moves the prefix, and builds and runs the C and the C++ consumer from there: by find_package and
# by pkg-config, with the shared and with the static library. CC, CXX, CMAKE and the usual *FLAGS are honoured.
set -eu
build=$1
work=$2
version=$3
project=$(cd "$(dirname "$0")" && pwd)/project
cmake=${CMAKE:-cmake}
cc=${CC:-cc}
cxx=${CXX:-c++}

fail()
{
    echo "consumer test: $*" >&2
    exit 1
}

# expect PROGRAM...: it must print the version and nothing else.
expect()
{
    got=$("$@") || fail "$* failed"
    [ "$got" = "$version" ] || fail "$* printed '$got', expected '$version'"
    echo "ok: $*"
}

# Which library a program was linked to shows in what it asks the loader for.
check_linkage()
{
    if readelf -d "$2" | grep -q 'NEEDED.*libsoftshadow'; then linkage=shared; else linkage=static; fi
    [ "$linkage" = "$1" ] || fail "$2 is linked to the $linkage library, expected the $1 one"
    if readelf -d "$2" | grep -q 'NEEDED.*libvulkan'; then fail "$2 needs libvulkan"; fi
}

rm -rf "$work"
mkdir -p "$work"
work=$(cd "$work" && pwd)
"$cmake" --install "$build" --prefix "$work/first" >/dev/null
mv "$work/first" "$work/moved prefix"
prefix="$work/moved prefix"
if grep -rIlF -e "$work/first" -e "$build" "$prefix" | grep .; then fail "the files above name folders of the build"; fi

for kind in shared static; do
    expected=softshadow::$kind
    use_static=OFF
    [ $kind = shared ] || use_static=ON
    if ! { "$cmake" -S "$project" -B "$work/$kind" "-DCMAKE_PREFIX_PATH=$prefix" "-DEXPECTED=$expected" \
        -DSOFTSHADOW_USE_STATIC=$use_static -DCMAKE_BUILD_TYPE=Release &&
        "$cmake" --build "$work/$kind"; } >"$work/$kind.log" 2>&1; then
        cat "$work/$kind.log"
        fail "find_package, $kind"
    fi
    for language in c cpp; do
        check_linkage $kind "$work/$kind/consumer_$language"
        expect "$work/$kind/consumer_$language"
    done
done

pc=$(find "$prefix" -name softshadow.pc)
[ -f "$pc" ] || fail "no softshadow.pc"
PKG_CONFIG_PATH=$(dirname "$pc")
export PKG_CONFIG_PATH
[ "$(pkg-config --modversion softshadow)" = "$version" ] || fail "softshadow.pc has another version"
library=$(dirname "$pc")/..
# pkg-config quotes the space in the prefix for a shell, hence eval.
warnings="-Wall -Wextra -Wpedantic -Werror"
for language in c cpp; do
    if [ $language = c ]; then
        compile="$cc -std=c11 ${CFLAGS:-}"
    else
        compile="$cxx -std=c++17 ${CXXFLAGS:-}"
    fi
    eval "$compile $warnings $(pkg-config --cflags softshadow) \"\$project/consumer.$language\" -o \"\$work/pc_shared_$language\"" \
        "${LDFLAGS:-} $(pkg-config --libs softshadow)"
    check_linkage shared "$work/pc_shared_$language"
    expect env LD_LIBRARY_PATH="$library" "$work/pc_shared_$language"
    eval "$compile $warnings $(pkg-config --static --cflags softshadow) \"\$project/consumer.$language\" -o \"\$work/pc_static_$language\"" \
        "${LDFLAGS:-} -Wl,-Bstatic $(pkg-config --static --libs softshadow | sed 's/-lm/-Wl,-Bdynamic -lm/')" \
        "-Wl,-Bdynamic"
    check_linkage static "$work/pc_static_$language"
    expect "$work/pc_static_$language"
done
