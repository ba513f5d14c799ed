#!/bin/sh
# The benches of every stage, in the build of the tests: measured, or with --once run once each to see that they still do.
set -u
cd "$(dirname "$0")/../.." || exit 1
if ! ls benches/benches/*.rs >/dev/null 2>&1; then
    echo "benches: benches/benches holds none."
    exit 0
fi
if [ "${1:-}" = --once ]; then
    shift
    exec cargo test "$@" --workspace --bench '*'
fi
exec cargo bench "$@" --workspace --bench '*' --profile dev
