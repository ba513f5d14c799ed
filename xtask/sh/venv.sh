#!/bin/sh
# Makes .venv with dwell and its tools in it (editable), repairs it where it is broken, and is quick where it is right.
# The extension is built in the profile, folder and feature set of the tests (docs/decisions/0001-one-build-profile.md).
set -eu
cd "$(dirname "$0")/../.."
here=$(pwd -P)
venv="$here/.venv"
python=$(sh xtask/sh/python.sh)

works() { "$venv/bin/python" -c 'import sys, pip; sys.exit(sys.version_info < (3, 10))' >/dev/null 2>&1; }

if ! works; then
    echo "venv: making .venv with $python"
    rm -f "$venv/dwell-stamp"
    # Debian ships venv without ensurepip; a pip outside can then put one in.
    if ! "$python" -m venv --clear "$venv" >/dev/null 2>&1; then
        "$python" -m venv --clear --without-pip "$venv" >/dev/null 2>&1 &&
            "$python" -m pip --python "$venv/bin/python" install --quiet pip >/dev/null 2>&1 || true
    fi
    works || {
        echo "dwell needs Python's venv module with pip, and $python lacks one of them (on Debian: python3-venv)." >&2
        exit 1
    }
fi

# maturin installs where these point, and cargo compiles pyo3 again when they change.
export VIRTUAL_ENV="$venv" PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_QUIET=1
unset CONDA_PREFIX PYTHONHOME PYTHONPATH
locked=
[ "${CI:-}" != true ] || locked=--locked

# Whatever decides what is installed: a change of it, or a moved checkout, installs again.
stamp=$({ echo "$here"; cat python/pyproject.toml xtask/sh/venv.sh; grep '^version' Cargo.toml; } | cksum)
develop() { "$venv/bin/maturin" develop $locked --manifest-path python/Cargo.toml --features panic-for-tests "$@"; }

if [ "$(cat "$venv/dwell-stamp" 2>/dev/null)" = "$stamp" ] && "$venv/bin/maturin" --version >/dev/null 2>&1; then
    develop --skip-install
else
    rm -f "$venv/dwell-stamp"
    echo "venv: installing what python/pyproject.toml names"
    maturin=$(sed -n 's/^requires *= *\["\(maturin[^"]*\)"\].*/\1/p' python/pyproject.toml)
    "$venv/bin/python" -m pip install "$maturin" || {
        echo "dwell needs $maturin from the Python package registry, and pip cannot install it (see above)." >&2
        exit 1
    }
    develop --extras dev || {
        echo "dwell could not be built and installed into .venv (see above); if pip is what failed, remove .venv and try again." >&2
        exit 1
    }
    echo "$stamp" >"$venv/dwell-stamp"
fi
