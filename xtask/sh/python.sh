#!/bin/sh
# Prints the first Python that is new enough; says in one sentence that there is none.
set -u
for candidate in "${PYTHON:-}" python3 python3.14 python3.13 python3.12 python3.11 python3.10 python; do
    [ -n "$candidate" ] || continue
    if "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 10))' >/dev/null 2>&1; then
        # The interpreter itself, not a shim that depends on the folder it is called in.
        exec "$candidate" -c 'import sys; print(sys.executable)'
    fi
done
echo "dwell needs Python 3.10 or newer, and neither python3 nor \$PYTHON is one." >&2
exit 1
