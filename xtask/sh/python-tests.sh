#!/bin/sh
# pytest over the package's tests and those that cross engines. Of the long ones, `@pytest.mark.long`, a share (share.sh); all of
# them, and the slow ones, with DWELL_TEST_ALL=1.
set -u
cd "$(dirname "$0")/../.." || exit 1
folders=
for folder in python/tests tests/python; do
    [ ! -d "$folder" ] || folders="$folders $folder"
done
only='not slow'
[ -z "${DWELL_TEST_ALL:-}" ] || only=
DWELL_TEST_SHARE=$(sh xtask/sh/share.sh) || exit 1
export DWELL_TEST_SHARE
# One process a core, at most four: each holds houses of its own.
# shellcheck disable=SC2086 # a list of folders
exec .venv/bin/python -m pytest --config-file python/pyproject.toml --rootdir . --quiet -m "$only" \
    --numprocesses auto --maxprocesses 4 --dist worksteal "$@" $folders
