#!/bin/sh
# What a stranger finds who installs the wheel: no Rust, no network, an empty environment. Everything lies in out/stranger.
# With a network: gathers the wheels of what dwell needs. Then, in a network namespace of its own, stranger-alone.sh.
set -eu
cd "$(dirname "$0")/../.."
here=$(pwd -P)
place="$here/out/stranger"
machine=$(uname -m)

wheel=$(find dist -name "dwell-*manylinux*_$machine.whl" 2>/dev/null | head -n 1)
if [ -z "$wheel" ]; then
    echo "stranger: dist/ holds no wheel for Linux on $machine; make wheel makes it." >&2
    exit 1
fi
if ! unshare -rn true 2>/dev/null; then
    echo "stranger: this system does not let a user make a network namespace (unshare -rn)." >&2
    exit 1
fi
python=$(sh xtask/sh/python.sh)

rm -rf "$place"
mkdir -p "$place/wheels" "$place/home"
"$python" -m pip --disable-pip-version-check download --quiet --only-binary :all: --dest "$place/wheels" "$wheel"
exec unshare -rn env -i PATH=/usr/bin:/bin LANG=C.UTF-8 HOME="$place/home" \
    sh xtask/sh/stranger-alone.sh "$python" "$place" "$@"
