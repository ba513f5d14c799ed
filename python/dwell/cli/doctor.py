"""``dwell doctor``: what this machine and this build have."""

from __future__ import annotations

import argparse
import importlib.util
import platform
import sys
from typing import Any

from dwell.cli.common import print_json

_EXTRAS = {
    "gymnasium": ("environments", "pip install gymnasium"),
    "PIL": ("pictures and the demo", "pip install pillow"),
    "rerun": (
        "`dwell demo` writes a recording for the Rerun viewer",
        "pip install rerun-sdk",
    ),
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Prints what is there, what is missing, and how to get it."""
    from dwell.machine_info import facts_of_machine

    facts = facts_of_machine()
    facts["python"] = platform.python_version()
    facts["extras"] = {name: importlib.util.find_spec(name) is not None for name in _EXTRAS}
    if args.json:
        print_json(facts)
        return 0
    print(f"dwell {facts['version']} for {facts['target']}, Python {facts['python']}")
    print(f"processor: {_threads(facts)}")
    print(f"instructions: {', '.join(facts['cpu_features']) or 'none that are looked for'}")
    print("rendering: cpu, unless --backend, renderer= or DWELL_RENDERER says otherwise")
    for adapter in facts["graphics_adapters"]:
        kind, interface = adapter["kind"], adapter["interface"]
        how = f"gpu:{adapter['name']}" if kind == "software" else "gpu"
        print(f"graphics adapter: {adapter['name']} ({kind}, {interface}), taken by {how!r}")
        print(f"  {_path(adapter)}")
    if not facts["graphics_adapters"]:
        print("graphics adapters: none (no Vulkan, Metal, DX12 or GL driver)")
    print(f"built-in houses: {', '.join(facts['houses'])}")
    for name, there in facts["extras"].items():
        purpose, how = _EXTRAS[name]
        print(f"{name}: {'there' if there else f'missing ({purpose}): {how}'}")
    print(f"Python at {sys.executable}")
    return 0


def _threads(facts: dict[str, Any]) -> str:
    """The number of threads that are used, and the reason for it."""
    cores, machine, most = (
        facts[key] for key in ("available_cores", "machine_threads", "threads_variable")
    )
    of = "" if machine in (None, cores) else f" of the machine's {machine}"
    why = f"affinity and quota leave {cores}{of}" if of else f"all {cores} cores of the machine"
    allowed = "DWELL_THREADS is not set" if most is None else f"DWELL_THREADS allows {most}"
    return f"{facts['threads']} threads used ({why}; {allowed})"


def _path(adapter: dict[str, Any]) -> str:
    """Which path an adapter takes, and why."""
    if "fault" in adapter:
        return f"cannot be used: {adapter['fault']}"
    speeds = (f"{name} {adapter[f'{name}_views_per_s']:.0f}" for name in ("compute", "raster"))
    return f"path {adapter['path']}, the quicker one: views of 64x64 a second, {', '.join(speeds)}"
