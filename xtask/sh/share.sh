#!/bin/sh
# Which of four shares of the long tests `make test` runs, 1 to 4: by the commit, so that every share has its turn and one commit
# always runs the same; DWELL_TEST_SHARE chooses another.
set -u
cd "$(dirname "$0")/../.." || exit 1
share=${DWELL_TEST_SHARE:-}
if [ -z "$share" ]; then
    commit=$(git rev-parse --verify --quiet HEAD 2>/dev/null || echo 0)
    digit=${commit#"${commit%?}"}
    share=$((0x$digit % 4 + 1))
fi
case $share in
[1-4]) echo "$share" ;;
*)
    echo "DWELL_TEST_SHARE is '$share', and the shares of long tests are 1, 2, 3 and 4." >&2
    exit 1
    ;;
esac
