#!/bin/sh
# usage: symbols.sh SHARED_LIBRARY STATIC_LIBRARY
# The shared library exports softsh_* and nothing else; the static archive's global names are softsh_* or softshi_*, since
# hidden visibility does not protect an archive; what both need from outside is the C library, never the Vulkan loader.
set -eu
shared=$1
static=$2
status=0
for file in "$shared" "$static"; do
    if [ ! -s "$file" ]; then
        echo "symbol test: $file is missing" >&2
        exit 1
    fi
done

report()
{
    if [ -n "$2" ]; then
        echo "symbol test: $1:" >&2
        echo "$2" | sed 's/^/    /' >&2
        status=1
    fi
}

# Names that end in @VERSION come from a shared library; sanitized builds add their own.
names()
{
    nm "$@" | sed -n 's/^[0-9a-f ]*[A-Za-z] //p' | sed 's/@.*//' | grep -vE '^__(asan|ubsan|odr_asan|sanitizer)' | sort -u
}

exported=$(names -D --defined-only "$shared")
[ "$(echo "$exported" | grep -c '^softsh_')" -ge 10 ] || report "too few exports" "${exported:-none}"
report "exported, but not softsh_*" "$(echo "$exported" | grep -v '^softsh_' || true)"

global=$(names --defined-only --extern-only "$static")
[ "$(echo "$global" | grep -c '^softsh_')" -ge 10 ] || report "too few globals in the archive" "${global:-none}"
report "global in the archive, but neither softsh_* nor softshi_*" "$(echo "$global" | grep -vE '^softshi?_' || true)"

undefined=$(names --undefined-only "$static" | grep -vE '^(softshi?_|_GLOBAL_OFFSET_TABLE_)' || true)
report "Vulkan functions linked directly" "$(echo "$undefined" | grep '^vk' || true)"

needed=$(readelf -d "$shared" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p' | grep -vE '^(libc|libm|libasan|libubsan)\.so' || true)
report "needed besides the C library" "$needed"

# All of it must be found in the C library and its mathematics: compare with what they define.
c=$(for library in libc.so.6 libm.so.6; do
    path=$(ldd "$shared" | sed -n "s/.*$library => \([^ ]*\).*/\1/p")
    [ -z "$path" ] || nm -D --defined-only "$path"
done | sed -n 's/^[0-9a-f ]*[A-Za-z] //p' | sed 's/@.*//' | sort -u)
weak='^(__gmon_start__|_ITM_deregisterTMCloneTable|_ITM_registerTMCloneTable|__cxa_finalize|__stack_chk_fail)$'
foreign=$(names -D --undefined-only "$shared" | grep -vE "$weak" | while read -r name; do
    echo "$c" | grep -qxF -e "$name" || echo "$name"
done)
report "undefined and not in the C library" "$foreign"
exit $status
