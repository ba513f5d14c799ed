#!/bin/sh
# Unit and integration tests, by cargo-nextest where it is installed. Of the long ones, `#[ignore = "long: ..."]`, a share (share.sh);
# all of them with DWELL_TEST_ALL=1.
set -u
cd "$(dirname "$0")/../.." || exit 1
nextest() {
    cargo nextest run "$@" --workspace --status-level slow --final-status-level slow --show-progress none
}
plain() {
    cargo test --workspace --lib --bins --tests --examples --no-fail-fast --quiet "$@"
}
if [ -n "${DWELL_TEST_ALL:-}" ]; then
    if cargo nextest --version >/dev/null 2>&1; then
        nextest "$@" --run-ignored all
    else
        plain "$@" -- --include-ignored --skip "$(sed -n 's/^default-filter = "not test(\(.*\))"$/\1/p' .config/nextest.toml)"
    fi
    exit
fi
share=$(sh xtask/sh/share.sh) || exit 1
status=0
if cargo nextest --version >/dev/null 2>&1; then
    nextest "$@" || status=1
    echo "long tests, share $share (all: make test-all; one: DWELL_TEST_SHARE=${share%/*})"
    nextest "$@" --run-ignored only --partition "hash:$share" || status=1
else
    plain "$@" || status=1
    echo "long tests need cargo-nextest, or make test-all"
fi
exit $status
