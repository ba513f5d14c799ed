"""The wheel of `make wheel`: what it needs, what it carries, and how a stranger fares with it."""

from __future__ import annotations

import platform
import re
import shutil
import subprocess
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
#: Of manylinux_2_28.
NEWEST_GLIBC = (2, 28)


@pytest.fixture(scope="module")
def wheel() -> Path:
    if platform.system() != "Linux":
        pytest.skip("the wheel is for Linux")
    found = sorted(ROOT.glob(f"dist/dwell-*manylinux*_{platform.machine()}.whl"))
    if not found:
        pytest.skip("no wheel in dist/; `make wheel` makes one")
    return found[0]


@pytest.fixture(scope="module")
def content(wheel: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(wheel) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def test_it_is_of_the_stable_abi_and_of_manylinux(wheel: Path) -> None:
    assert re.fullmatch(r"dwell-[\d.]+-cp310-abi3-manylinux_2_28_\w+\.whl", wheel.name)


def test_it_asks_for_no_newer_glibc_than_its_name_says(content: dict[str, bytes]) -> None:
    extension = content["dwell/_native.abi3.so"]
    versions = {
        tuple(map(int, found))
        for found in re.findall(rb"\0GLIBC_(\d+)\.(\d+)(?:\.\d+)?", extension)
    }
    assert versions
    assert max(versions) <= NEWEST_GLIBC


def test_it_unwinds_by_the_systems_library_as_python_does(content: dict[str, bytes]) -> None:
    extension = content["dwell/_native.abi3.so"]
    assert b"\0libgcc_s.so.1\0" in extension
    # What LLVM's unwinder says before it gives up.
    assert b"libunwind: " not in extension


def test_it_names_no_folder_of_the_machine_that_built_it(content: dict[str, bytes]) -> None:
    home, root = str(Path.home()).encode(), str(ROOT).encode()
    for name, data in content.items():
        assert root not in data, name
        assert home + b"/" not in data, name


def test_it_carries_the_terms_of_every_crate_inside(content: dict[str, bytes]) -> None:
    terms = {
        name.split("/licenses/")[1]: data.decode()
        for name, data in content.items()
        if "/licenses/" in name
    }
    assert {"LICENSE-MIT", "LICENSE-APACHE", "third-party/rust-standard-library.html"} <= set(terms)
    works, _, texts = terms["third-party/crates.txt"].partition("=" * 80)
    lines = [line for line in works.splitlines() if re.search(r" \| .* \[[\d, ]+\]$", line)]
    for name in ("rapier3d", "wgpu", "pyo3", "gltf", "zig compiler-rt"):
        assert any(line.startswith(f"{name}") for line in lines), name
    assert not any(line.startswith(("dwell", "syn ", "serde_derive ")) for line in lines)
    numbers = {int(n) for line in lines for n in re.findall(r"\d+", line.rpartition("[")[2])}
    assert numbers == {int(n) for n in re.findall(r"={80}\n\[(\d+)\]\n", "=" * 80 + texts)}


@pytest.mark.slow
def test_a_stranger_without_rust_and_network_gets_along(wheel: Path) -> None:
    unshare = shutil.which("unshare")
    if unshare is None or subprocess.run([unshare, "-rn", "true"], check=False).returncode != 0:
        pytest.skip("this system lets nobody make a network namespace (unshare -rn)")
    told = subprocess.run(
        ["sh", "xtask/sh/stranger.sh"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
        timeout=1200,
    )
    assert told.returncode == 0, told.stdout + told.stderr
