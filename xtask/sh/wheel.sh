#!/bin/sh
# The wheel that strangers install, in dist/. For Linux, zig links against the glibc of manylinux_2_28, whatever this machine
# has; other systems get a wheel of their own kind, which nobody has tried.
set -eu
cd "$(dirname "$0")/../.."
here=$(pwd -P)
bin="$here/.venv/bin"
# The linker and its libraries, as a Python package.
ziglang='ziglang>=0.17,<0.18'
glibc=manylinux_2_28

# maturin looks for the ziglang of the first python3.
export PATH="$bin:$PATH" VIRTUAL_ENV="$here/.venv" PIP_DISABLE_PIP_VERSION_CHECK=1
# What a panic says of places in the source shall not name this machine's folders.
registries=${CARGO_HOME:-$HOME/.cargo}/registry/src
flags="--remap-path-prefix=$here=dwell"
for sources in "$registries"/*; do
    flags="$flags$(printf '\037')--remap-path-prefix=$sources=crates"
done
build() {
    CARGO_ENCODED_RUSTFLAGS="$flags" "$bin/maturin" build --release --manifest-path python/Cargo.toml --compression-level 9 \
        --out dist "$@"
}

# For Linux. Threads that Python ends are unwound by the system's libgcc_s (docs/python-border.md), so the extension must unwind by it,
# too: zig would link an unwinder of its own, and each reads the other's memory as its own.
build_for_linux() {
    target=$1
    shift
    folder="$here/target/libgcc_s/$target"
    mkdir -p "$folder"
    "$bin/python" -m ziglang cc -target "${target%%-*}-linux-gnu.2.28" -shared -nostdlib -Wl,-soname,libgcc_s.so.1 \
        -o "$folder/libgcc_s.so" xtask/libgcc_s.c
    build --zig --compatibility "$glibc" --target "$target" "$@" -- -C link-arg="$folder/libgcc_s.so"
}

rm -f dist/dwell-*.whl
"$bin/python" -m pip install --quiet "$ziglang" || {
    echo "the wheel needs $ziglang from the Python package registry, and pip cannot install it (see above)." >&2
    exit 1
}
cargo xtask notices
if [ "$(uname -s)" != Linux ]; then
    build "$@"
    echo "wheel: for $(uname -s), which is untested."
    exit 0
fi
own=$(rustc -vV | sed -n 's/^host: //p')
build_for_linux "$own" "$@"
for target in x86_64-unknown-linux-gnu aarch64-unknown-linux-gnu; do
    [ "$target" != "$own" ] || continue
    if [ -d "$(rustc --print target-libdir --target "$target" 2>/dev/null)" ]; then
        build_for_linux "$target" "$@"
        echo "wheel: the one for ${target%%-*} is built here and run nowhere."
    else
        echo "wheel: none for ${target%%-*}: the toolchain lacks $target (rustup target add $target)."
    fi
done
