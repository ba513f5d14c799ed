#!/bin/sh
# Everything the tests run. Tests first: the extension then finds every dependency compiled.
set -eu
cd "$(dirname "$0")/../.."
target=${CARGO_TARGET_DIR:-target}
cold=
[ -d "$target/debug/deps" ] || cold=yes
started=$(date +%s)
sh xtask/sh/stage.sh 'build of tests' cargo test "$@" --workspace --no-run
sh xtask/sh/stage.sh 'extension and .venv' sh xtask/sh/venv.sh
# Shown by `cargo xtask sizes`.
[ -z "$cold" ] || echo "$(($(date +%s) - started))" >"$target/cold-build-seconds"
