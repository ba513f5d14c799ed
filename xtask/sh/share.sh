#!/bin/sh
# Which share of the long tests `make test` runs, as "1/8" to "8/8": by the commit, so that every share has its turn and one
# commit always runs the same; DWELL_TEST_SHARE chooses another, with or without the "/8".
set -u
cd "$(dirname "$0")/../.." || exit 1
shares=8
share=${DWELL_TEST_SHARE:-}
share=${share%/$shares}
if [ -z "$share" ]; then
    commit=$(git rev-parse --verify --quiet HEAD 2>/dev/null || echo 0)
    digit=${commit#"${commit%?}"}
    share=$((0x$digit % shares + 1))
fi
case $share in
[1-8]) echo "$share/$shares" ;;
*)
    echo "DWELL_TEST_SHARE is '$share', and the shares of long tests are 1 to $shares." >&2
    exit 1
    ;;
esac
