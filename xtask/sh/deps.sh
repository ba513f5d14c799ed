#!/bin/sh
# Optional system packages, by apt. Nothing here is needed to build, to test or to run the demo: what lacks one skips visibly.
set -u
packages="mesa-vulkan-drivers" # software Vulkan, for the GPU back end on machines without a GPU

without() {
    echo "deps: $1; dwell goes on without $packages, and tests that need it will say that they skip."
    exit 0
}

command -v apt-get >/dev/null 2>&1 || without "there is no apt-get here"
missing=
for package in $packages; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
done
if [ -z "$missing" ]; then
    echo "deps: $packages is here."
    exit 0
fi
as_root=
if [ "$(id -u)" -ne 0 ]; then
    sudo -n true >/dev/null 2>&1 || without "installing needs root, and sudo would ask for a password"
    as_root="sudo -n"
fi
apt() {
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=120 -o Dpkg::Use-Pty=0 "$@" </dev/null
}
# shellcheck disable=SC2086 # a list of names
apt update && apt install -y --no-install-recommends $missing || without "apt-get failed"
echo "deps: installed$missing."
