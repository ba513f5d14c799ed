#!/bin/sh
# Unit and integration tests, by cargo-nextest where it is installed.
set -u
if cargo nextest --version >/dev/null 2>&1; then
    exec cargo nextest run "$@" --workspace --status-level slow --final-status-level slow --show-progress none
fi
exec cargo test "$@" --workspace --lib --bins --tests --examples --no-fail-fast --quiet
