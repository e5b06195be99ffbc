#!/usr/bin/env bash
# scripts/soundness.sh [miri|address|threads]...
# Runs tests under tools that detect memory errors of unsafe and foreign code, on x86-64 Linux; all three take half an hour.
# Needs a nightly Rust: rustup toolchain install nightly --component miri --component rust-src
#
# miri skips AVX-512, which it does not support, and meshopt's C++ (address runs both); whole pictures, worlds and batches, which
# would take minutes each (address and threads run them); and Python, whose only view is read-only. address
# ignores leaks, because nothing is freed by hand and the test harness leaks. threads runs only code that starts threads.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
[ "$#" -gt 0 ] || set -- miri address threads

# tested TOOL PACKAGE ARGUMENT...
tested() {
    echo "== $1: ${*:2}"
    CARGO_TARGET_DIR="target/soundness/$1" timeout 30m rustup run nightly cargo "${command[@]}" -p "${@:2}"
}

for tool in "$@"; do
    command=(test --target x86_64-unknown-linux-gnu)
    case "$tool" in
        miri)
            command=(miri test)
            export MIRIFLAGS=-Zmiri-disable-isolation RUSTFLAGS="-C target-feature=+avx2" PROPTEST_CASES=2
            tested miri driftworld-env --lib -- render::lanes batch::depth
            tested miri driftworld-env --lib -- agents::grid agents::script:: assets::blocks
            ;;
        address)
            # meshopt's C++ is checked too. Two of its tables are private to their files, and would be reported as defined twice.
            export RUSTFLAGS=-Zsanitizer=address CXXFLAGS="-fsanitize=address -fno-omit-frame-pointer" PROPTEST_CASES=64
            export ASAN_OPTIONS=detect_leaks=0:detect_odr_violation=0
            tested address driftworld-env --features gltf --lib -- assets
            tested address driftworld-env --features gltf --tests -- import hostile pictures
            ;;
        threads)
            command+=(-Zbuild-std)
            export RUSTFLAGS="-Zsanitizer=thread -Cunsafe-allow-abi-mismatch=sanitizer" PROPTEST_CASES=8
            tested threads driftworld-env --lib -- batch
            tested threads driftworld-env --tests -- batch
            ;;
        *)
            echo "scripts/soundness.sh: found unknown tool $tool, expected miri, address or threads" >&2
            exit 2
            ;;
    esac
done
