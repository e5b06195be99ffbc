#!/usr/bin/env bash
# scripts/fuzz.sh SECONDS [TARGET]...
# Runs libFuzzer for SECONDS on each of the named targets, or on all. The targets check the laws in fuzz/src/, which the tests
# check on the seeds. Needs x86-64 Linux and a nightly Rust (rustup toolchain install nightly).
#
# Inputs that reach new code are kept in fuzz/corpus/, where the next run starts; inputs that break a law are in fuzz/artifacts/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../fuzz"
seconds="${1:?usage: scripts/fuzz.sh SECONDS [TARGET]...}"
shift
[ "$#" -gt 0 ] || set -- $(ls seeds)

# The compiler flags with which cargo-fuzz measures coverage.
machine=x86_64-unknown-linux-gnu
export RUSTFLAGS="--cfg fuzzing -Ccodegen-units=1 -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
-Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
-Cllvm-args=-sanitizer-coverage-trace-compares"
rustup run nightly cargo build --release --manifest-path targets/Cargo.toml --target "$machine" --target-dir ../target/fuzz

broken=()
for target in "$@"; do
    mkdir -p "corpus/$target" "artifacts/$target"
    options=(-max_len=4096 -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 -reload=0 "-max_total_time=$seconds")
    options+=("-artifact_prefix=artifacts/$target/")
    [ ! -f "dictionaries/$target.txt" ] || options+=("-dict=dictionaries/$target.txt")
    echo "== $target"
    DRIFTWORLD_FUZZ_TARGET="$target" "../target/fuzz/$machine/release/fuzz" "${options[@]}" "corpus/$target" "seeds/$target" \
        2>&1 | grep -v "pulse\|NEW\|REDUCE\|RELOAD" || broken+=("$target")
done
[ "${#broken[@]}" -eq 0 ] || { echo "laws broken: ${broken[*]}; the input is in fuzz/artifacts/; add it to the seeds once the bug is fixed"; exit 1; }
