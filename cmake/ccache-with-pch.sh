#!/bin/bash
# Compiles through ccache: ccache-with-pch.sh CCACHE COMPILER ARGUMENTS...
#
# A precompiled header contains absolute paths, and GCC writes other bytes each time. ccache would hash them, and a clone
# in another folder would never hit the cache. This script compiles precompiled headers without ccache and writes the
# hash of all headers in them to a file with the suffix .sum, which ccache reads instead (CCACHE_PCH_EXTSUM).
#
# With Clang, CMake includes a precompiled header twice: as PCH, and by the absolute path of its text, which adds nothing.
# Where the PCH is used, the script leaves the second out.
set -eo pipefail
arguments=()
compiles_header=
while [ $# -gt 0 ]; do
    case "$1 ${2:-} ${3:-} ${4:-}" in
    '-Xclang -emit-pch '* | '-x c++-header '*) compiles_header=yes ;;
    '-MF '*) dependencies=$2 ;;
    '-o '*) output=$2 ;;
    '-Xclang -include -Xclang '*/cmake_pch.hxx)
        if [ -z "$compiles_header" ]; then
            shift 4
            continue
        fi
        ;;
    esac
    arguments+=("$1")
    shift
done
if [ -z "$compiles_header" ]; then
    exec "${arguments[@]}"
fi

"${arguments[@]:1}"
# The header that CMake writes includes the others by an absolute path.
sed -e 's/^[^:]*://' -e 's/\\$//' "$dependencies" | tr ' ' '\n' | grep -v -e '^$' -e cmake_pch | xargs cat |
    sha256sum >"$output.sum"
