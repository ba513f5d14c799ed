#!/bin/sh
# Checks the three things that cannot be installed from a registry: Rust, a C compiler (the linker), Python.
set -u
cd "$(dirname "$0")/../.." || exit 1

wanted=$(sed -n 's/^rust-version *= *"\([0-9.]*\)".*/\1/p' Cargo.toml)
if ! command -v cargo >/dev/null 2>&1; then
    echo "dwell needs Rust $wanted or newer, and there is no cargo on the PATH (rustup installs it)." >&2
    exit 1
fi
found=$(rustc --version 2>/dev/null | sed -n 's/^rustc \([0-9]*\.[0-9]*\).*/\1/p')
if ! printf '%s\n%s\n' "$wanted" "${found:-0.0}" | awk -F. '
    NR == 1 { major = $1; minor = $2 } NR == 2 { exit !($1 > major || ($1 == major && $2 >= minor)) }'; then
    echo "dwell needs Rust $wanted or newer, and this is ${found:-no working rustc} (rustup update)." >&2
    exit 1
fi
if ! command -v cc >/dev/null 2>&1; then
    echo "dwell needs a C compiler to link with, and there is no cc on the PATH (for example gcc or clang)." >&2
    exit 1
fi
exec sh xtask/sh/python.sh >/dev/null
