#!/usr/bin/env bash
# Builds a wheel and an archive of the programs for each target, with checksums, in target/packages. Nothing is uploaded.
#
#     scripts/dist.sh [TARGET]...     # by default x86_64-unknown-linux-gnu and aarch64-unknown-linux-gnu
#
# They are linked by zig, so they run with glibc 2.28 and later, whatever this machine has. The page of the workbench needs Node.js.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
known=(x86_64-unknown-linux-gnu aarch64-unknown-linux-gnu)
[ $# -gt 0 ] || set -- "${known[@]}"
for target; do
    case " ${known[*]} " in
        *" $target "*) ;;
        *) echo "scripts/dist.sh: found target $target, expected one of ${known[*]}" >&2 && exit 2 ;;
    esac
    [ -d "$(rustc --print target-libdir --target "$target")" ] || {
        echo "scripts/dist.sh: found no standard library of Rust for $target; run rustup target add $target" >&2 && exit 1
    }
done
tools=target/python/dist out=target/packages
python3 -m venv "$tools"
"$tools/bin/python" -m pip install --quiet --disable-pip-version-check --requirement scripts/dist.txt
export PATH="$PWD/$tools/bin:$PATH"
export CARGO_TARGET_DIR="$PWD/target"
mkdir -p "$out"
# The page of the workbench is embedded into every program.
cargo xtask studio
export DRIFTWORLD_STUDIO="$PWD/target/studio"
version="$(cargo pkgid --package driftworld)" && version="${version##*[#@]}"
for target; do
    # The wheel is for Python 3.10 and later, and has all features and the command.
    maturin build --manifest-path python/Cargo.toml --profile dist --features full --zig --compatibility manylinux_2_28 \
        --target "$target" --out "$out"
    cargo zigbuild --profile dist --target "$target.2.28" --package driftworld --features full
    cargo zigbuild --profile dist --target "$target.2.28" --package driftworld-unity
    name="driftworld-$version-${target%%-*}-linux"
    rm -rf "${out:?}/$name" && mkdir "$out/$name"
    cp target/"$target"/dist/driftworld{,-unity} README.md LICENSE-* CITATION.cff "$out/$name"
    tar -C "$out" --sort=name --owner=0 --group=0 --numeric-owner --mtime=@0 -czf "$out/$name.tar.gz" "$name"
    rm -r "${out:?}/$name"
done
cd "$out"
sha256sum ./*.whl ./*.tar.gz > SHA256SUMS
ls -l
cat SHA256SUMS
