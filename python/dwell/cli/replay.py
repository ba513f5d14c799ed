"""``dwell replay``: a recorded episode, checked, and seen and heard again."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

from dwell.camera import CLASSES, PRESETS, Camera
from dwell.cli.common import (
    ProgressBar,
    add_back_end,
    back_end,
    count,
    image_edge,
    number,
    path,
    print_json,
    refuse_unused,
)
from dwell.cli.write_files import add_bits, save_sound, write_image
from dwell.engine_types import Channel

if TYPE_CHECKING:
    from dwell.replay_agents import ReplayAgent
    from dwell.replays import Replay, ReplayStep

#: Beside the pictures, what ``--sensors`` takes.
_AUDIO = "audio"


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument("file", metavar="FILE", type=path, help="as ReplayRecorder writes it")
    parser.add_argument(
        "--verify",
        action="store_true",
        help="all that the file states holds, every step's bits too, or fail",
    )
    parser.add_argument(
        "--sensors",
        help=f"what to take at the agent's eyes and ears: {','.join(get_args(Channel))},{_AUDIO}",
    )
    parser.add_argument("--agent", metavar="NAME", help="of several whose; default the first")
    parser.add_argument("--every", type=count, default=1, help="take a picture every so many steps")
    parser.add_argument("--width", type=image_edge, default=320)
    parser.add_argument("--height", type=image_edge, default=240)
    parser.add_argument("--fov-deg", type=number, default=90.0, help="horizontal field of view")
    parser.add_argument("--preset", choices=PRESETS, default="lit")
    parser.add_argument("--classes", choices=CLASSES, default="coarse", help="those of semantic")
    add_back_end(parser)
    add_bits(parser)
    parser.add_argument("--out", type=path, metavar="DIR", help="where --sensors go")
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Plays the episode if anything asks for it, and says what it is."""
    from dwell.replay_agents import agent_rows
    from dwell.replays import Replay

    if (args.sensors is None) != (args.out is None):
        raise ValueError("--sensors and --out DIR are given together")
    if args.every < 1:
        raise ValueError("--every is 0; allowed are whole numbers from 1")
    if args.sensors is None:
        refuse_unused(args, {"file", "verify", "json"}, "a replay without --sensors")
    replay = Replay.read(args.file)
    taker = None if args.sensors is None else _Taker(args, _place(replay, args.agent))
    told: dict[str, Any] = {
        "house": replay.house,
        "instruction": replay.instruction,
        "steps": len(replay.actions),
        "success": replay.success,
    }
    if replay.agents:
        told["agents"] = agent_rows(replay.agents)
    if args.verify:
        told["differences"] = replay.differences()
    if taker is not None:
        _take(replay, args, taker)
        told["files"] = taker.files
        told |= taker.sound
    different = told.get("differences", [])
    if args.json:
        print_json(told)
    else:
        for name, value in told.items():
            if name == "agents":
                for agent in replay.agents:
                    print(f"{agent.name}: {_outcome(agent)}")
                continue
            print(f"{name}: {(value or 'none') if name == 'differences' else value}")
    for sentence in different:
        print(f"{args.file}: {sentence}", file=sys.stderr)
    return 1 if different else 0


def _place(replay: Replay, name: str | None) -> int:
    """The place of the agent whose eyes and ears are asked for."""
    names = [agent.name for agent in replay.agents]
    if name is None:
        return 0
    if name not in names:
        allowed = ", ".join(names) or "none: it is an episode of one agent"
        raise ValueError(f"--agent is {name!r}; allowed are {allowed}")
    return names.index(name)


def _outcome(agent: ReplayAgent) -> str:
    """What an agent was asked, and how it ended."""
    asked = agent.instruction or "nothing was asked"
    until = "went on to the end" if agent.ended is None else f"ended at step {agent.ended}"
    return f"{asked} {'succeeded' if agent.success else 'no success'}, {until}"


def _take(replay: Replay, args: argparse.Namespace, taker: _Taker) -> None:
    bar = ProgressBar()
    for moment in replay.play(renderer=back_end(args)):
        bar(moment.step / max(len(replay.actions), 1), replay.house)
        taker.take(moment)
    taker.finish()


class _Taker:
    """Takes what ``--sensors`` asks for at the steps of an episode, and writes it."""

    def __init__(self, args: argparse.Namespace, agent: int) -> None:
        known: tuple[Channel, ...] = get_args(Channel)
        names = [name.strip() for name in args.sensors.split(",")]
        for name in names:
            if name not in (*known, _AUDIO):
                allowed = ", ".join((*known, _AUDIO))
                raise ValueError(f"--sensors: no {name!r}; allowed are {allowed}")
        self._channels = [name for name in known if name in names]
        self._hears = _AUDIO in names
        self._camera = Camera(
            args.width, args.height, args.fov_deg, preset=args.preset, classes=args.classes
        )
        self._agent = agent
        self._out: Path = args.out
        self._every: int = args.every
        self._heard: list[Any] = []
        self._rate_hz = self._samples = 0
        self._bits: int = args.bits
        self.files: list[str] = []
        #: How samples of the written sound stand for pressure.
        self.sound: dict[str, Any] = {}

    def take(self, moment: ReplayStep) -> None:
        """Looks and listens at one step."""
        if self._channels and moment.step % self._every == 0:
            images = moment.world.render(
                agent=self._agent, camera=self._camera, channels=self._channels
            )
            for channel, image in images.items():
                name = f"{channel}_{moment.step:05}"
                self.files += write_image(self._out, name, channel, image)
        if self._hears:
            if moment.step == 0:
                self._rate_hz = moment.world.sound_rate_hz
                self._samples = moment.world.samples_a_step
            heard = moment.world.listen(self._samples, agent=self._agent)
            if moment.step:
                self._heard.append(heard)

    def finish(self) -> None:
        """Writes what was heard."""
        import numpy as np

        if self._heard:
            path = self._out / "audio.wav"
            sound = np.concatenate(self._heard, axis=1)
            self.sound = save_sound(path, sound, self._rate_hz, self._bits)
            self.files.append(str(path))
