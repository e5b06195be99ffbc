#!/bin/sh
# Lists third-party crates that a build folder holds more than once under one profile, and fails if there are any:
#
#     scripts/rebuilds.sh [TARGET]
#
# This happens if two of our crates request different features of a crate, and makes everyone wait for it twice;
# `features/Cargo.toml` unifies them. In a folder that was not empty before the build, the second copy may be an old one.
set -eu
target=${1:-target}
found=0
for profile in debug release; do
    deps=$target/$profile/deps
    twice=$(
        # Checks leave no library. The sources are in the file beside it, as a rule for `make`.
        for library in "$deps"/lib*.rlib "$deps"/lib*.so; do
            list=${library##*/lib}
            list=$deps/${list%.*}.d
            if [ -f "$library" ] && [ -f "$list" ]; then
                sed -n '/\/registry\/src\//{s|.*/registry/src/[^/]*/\([^/]*\)/.*|\1|p;q;}' "$list"
            fi
        done | sort | uniq -d
    )
    for package in $twice; do
        echo "rebuilds: found $package more than once in $deps, expected it once" >&2
        found=1
    done
done
[ "$found" = 0 ] || {
    echo "rebuilds: find which of its features each crate requests (cargo tree -e features -i CRATE --workspace), and list it with all of them in features/Cargo.toml" >&2
    exit 1
}
