#!/bin/sh
# The Rerun viewer's SDK, for the demo's recording: tried once, and the demo goes on without it.
set -u
cd "$(dirname "$0")/../.." || exit 1
if .venv/bin/python -c 'import rerun' >/dev/null 2>&1; then
    exit 0
fi
want=$(sed -n 's/^viewer *= *\["\([^"]*\)"\].*/\1/p' python/pyproject.toml)
echo "demo: installing $want, for the recording"
.venv/bin/python -m pip install --quiet --disable-pip-version-check --retries 1 --timeout 20 "$want" ||
    echo "demo: $want cannot be installed here; everything is written but the Rerun recording."
exit 0
