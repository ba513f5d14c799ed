#!/bin/sh
# The stranger's part, without network: stranger-alone.sh PYTHON FOLDER [options of stranger.py]. Called by stranger.sh.
set -eu
checks="$(cd "$(dirname "$0")/.." && pwd -P)/stranger.py"
python=$1
place=$2
shift 2
for tool in cargo rustc; do
    if command -v "$tool" >/dev/null 2>&1; then
        echo "stranger: $tool is on the PATH ($PATH), and a stranger has none." >&2
        exit 1
    fi
done
# Out of the repository, so that nothing of it is imported.
cd "$place"
"$python" -m venv --clear venv
venv/bin/python -m pip --disable-pip-version-check install --quiet --no-index --find-links wheels dwell
exec venv/bin/python -I "$checks" "$@"
