#!/usr/bin/env bash
# Tests a wheel, and optionally an archive, in a minimal Debian that has only Python: no compiler, no display, no network.
#
#     scripts/empty_root.sh WHEEL [ARCHIVE]      # run as root; the file names determine the architecture
#
# debootstrap creates the system in target/empty-root-ARCHITECTURE, or in the folder DRIFTWORLD_EMPTY_ROOT; it is kept for later runs.
# A different architecture needs qemu-user-static (Debian's package, with binfmt_misc mounted). Prints the seconds of each step.
set -euo pipefail
wheel="$(realpath "$1")"
case "$wheel" in
    *_x86_64.whl) architecture=amd64 machine=x86_64 ;;
    *_aarch64.whl) architecture=arm64 machine=aarch64 ;;
    *) echo "$wheel: found another name, expected one that ends with _x86_64.whl or _aarch64.whl" >&2 && exit 1 ;;
esac
root="$(realpath -m "${DRIFTWORLD_EMPTY_ROOT:-target/empty-root-$architecture}")"
if [ ! -e "$root/made" ]; then
    rm -rf "$root"
    debootstrap --arch="$architecture" --variant=minbase --include=python3,python3-venv bookworm "$root"
    touch "$root/made"
fi
rm -rf "$root/try" && mkdir -p "$root/try/wheels"
# Downloads what pip would fetch: the wheel's two dependencies and theirs, for the Python of that Debian.
platforms=()
for tag in 2_28 2_27 2_17; do platforms+=(--platform "manylinux_${tag}_$machine"); done
python3 -m pip download --quiet --only-binary :all: --python-version 3.11 "${platforms[@]}" --dest "$root/try/wheels" "numpy<3" gymnasium
cp "$wheel" ${2:+"$2"} "$root/try/"
cat > "$root/try/steps.sh" <<'STEPS'
set -eu
cd /try
mount -t proc proc /proc
step() {
    echo "== $*"
    begun=$(date +%s.%N)
    "$@" > log 2>&1 || { cat log; exit 1; }
    tail -n 2 log
    python3 -c "import sys; print(f'   {float(sys.argv[2]) - float(sys.argv[1]):.1f} s')" "$begun" "$(date +%s.%N)"
}
if command -v cc || command -v rustc; then echo "found a compiler, expected none" && exit 1; fi
uname -m
python3 --version
step python3 -m venv env
step env/bin/pip install --no-index --find-links wheels ./*.whl
step env/bin/driftworld render find_objects -o first.png
step env/bin/python -c "import driftworld, gymnasium; print(gymnasium.make('driftworld/FindObjects-v0').reset(seed=0)[0]['rgb'].shape)"
step env/bin/python -m driftworld.check find_objects
step env/bin/driftworld demo
step env/bin/driftworld studio --export page
test -s page/index.html
du -sm env
for archive in ./*.tar.gz; do
    [ -e "$archive" ] || continue
    step tar xzf "$archive"
    step driftworld-*-linux/driftworld render find_objects -o second.png
    cmp first.png second.png
    du -sm driftworld-*-linux
done
sha256sum first.png
STEPS
unshare --net --mount --pid --fork env -i PATH=/usr/bin:/bin:/usr/sbin:/sbin HOME=/root chroot "$root" sh /try/steps.sh
