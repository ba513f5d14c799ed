#!/bin/sh
# The documentation site, in out/site. What it needs is the extra `docs` of python/pyproject.toml, installed into .venv.
set -eu
cd "$(dirname "$0")/../.."
python=.venv/bin/python
export PIP_DISABLE_PIP_VERSION_CHECK=1 NO_MKDOCS_2_WARNING=1

# Each as `name==version`, from what is installed: asked for by name, pip might take another dwell out of an index.
want=$("$python" - <<'END'
import importlib.metadata as installed

extra = '; extra == "docs"'
rows = [row.replace("'", '"') for row in installed.requires("dwell") or []]
for row in (row.removesuffix(extra).strip() for row in rows if row.endswith(extra)):
    name, _, version = row.partition("==")
    try:
        there = installed.version(name) == version
    except installed.PackageNotFoundError:
        there = False
    if not there:
        print(row)
END
)
if [ -n "$want" ]; then
    echo "docs: installing" $want
    # shellcheck disable=SC2086 # a list of packages
    "$python" -m pip install --quiet $want || {
        echo "the site needs" $want "from the Python package registry, and pip cannot install them (see above)." >&2
        exit 1
    }
fi
# Not --quiet: then warnings are not counted, and strict lets broken links pass.
"$python" -m mkdocs build --strict "$@"
echo "Open out/site/index.html"
