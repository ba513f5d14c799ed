"""Contents of a recording: a house as it stands, and an episode."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from dwell import _native
from dwell.acoustics import AcousticScene
from dwell.arguments import from_json
from dwell.camera import Camera
from dwell.house import House
from dwell.recording.agents import RecordedAgents
from dwell.recording.viewer import Recording
from dwell.replay_agents import PlayedAgents, ReplayAgent, scripted_places, with_ears
from dwell.replays import Replay
from dwell.world import World

#: Where ears are over a floor, m.
_EAR_M = 1.5
#: After so many steps an episode is left.
_MAX_STEPS = 2000


def record_house(recording: Recording, world: World) -> None:
    """All of a house as it stands: surfaces and fixtures, a view of each room, what sounds."""
    recording.house(world)
    rooms = world.house.rooms()
    for room in rooms:
        recording.view(world, room["name"], room["eye"], room["yaw_deg"])
    sources = _native.fixtures(world.native)["sources"]
    sounding = [source for source in sources if source["on"]]
    if not sounding or not rooms:
        return
    scene = AcousticScene(world.house)
    for source in sounding:
        listener = _listener(source["position"], rooms)
        paths = scene.early_paths(source["position"], listener)
        recording.sound(source["name"], paths, listener)


def record_episode(recording: Recording, house: House, task: str, seed: int) -> int:
    """An episode as the task's scripted expert plays it: its way, and what it saw at every step.

    Returns:
        How many steps it took.

    Raises:
        ConfigError: There is no such task.
        DwellError: The house has nothing to do for it.
    """
    from dwell.envs.single import DwellEnv

    camera = Camera(256, 192, 90.0)
    sensors = {"rgb": {"width": camera.width, "height": camera.height, "fov_deg": 90.0}}
    env = DwellEnv(task, houses=house, sensors={**sensors, "instruction": {}})
    observation, _ = env.reset(seed=seed)
    recording.text("instruction", str(observation["instruction"]))
    way, done, steps = [], False, 0
    while True:
        agent = env.agents()[0]
        way.append(agent["position"])
        recording.step(steps, agent, observation["rgb"], camera)
        if done or steps >= _MAX_STEPS:
            break
        observation, _, done, _, _ = env.step(np.int64(env.expert_action()))
        steps += 1
    recording.way(task, way)
    return steps


def record_agents(recording: Recording, house: House, task: str, agents: int, seed: int) -> int:
    """An episode of several agents, as the task's scripted experts play it.

    Returns:
        How many steps it took.

    Raises:
        ConfigError: There is no such task, or it is not for so many agents.
        DwellError: The house has nothing to do for it.
    """
    from gymnasium.utils import seeding

    from dwell.envs.action_modes import EngineActions
    from dwell.envs.agent_settings import MultiAgentSetup
    from dwell.envs.episode_shelf import shelf_of
    from dwell.envs.native_batch import NativeBatch

    setup = MultiAgentSetup.plain(task, agents)
    runner = NativeBatch([house], setup.config, None)
    # As an environment of PettingZoo draws its first episode.
    _, episode = shelf_of(house, None).draw(seeding.np_random(seed)[0])
    runner.reset([episode])
    world, names = runner.world(0), setup.roster.names
    unknown = [ReplayAgent(name, "", "", success=False, ended=None) for name in names]
    played = PlayedAgents(unknown, 0.0, [False] * len(names), runner)
    config = from_json("config", setup.config)
    listeners = [name for name, is_open in zip(names, with_ears(config), strict=True) if is_open]
    shown = RecordedAgents(recording, Camera(256, 192, 90.0), listeners)
    now = played.after(0, None, None, world)
    limit = _MAX_STEPS if setup.limit is None else min(setup.limit, _MAX_STEPS)
    step = 0
    while True:
        shown.step(step, world, now)
        acts = np.array([now[name].acts for name in names])
        if step >= limit or not acts.any():
            break
        step += 1
        actions = EngineActions(
            np.where(acts, runner.expert_actions(), -1),
            answers=runner.batch.expert_answers().reshape(len(names), -1),
            tokens=runner.batch.expert_utterances().reshape(len(names), -1),
        )
        played.before(actions, world)
        now = played.after(step, None, runner.step(actions)[0], world)
    shown.finish()
    return step


def record_replay(recording: Recording, house: House, replay: Replay) -> None:
    """A recorded episode as it went: its way, and what the agent saw at every step.

    Of an episode of several agents all of them, as :class:`RecordedAgents` shows them.
    """
    camera = Camera(256, 192, 90.0)
    if replay.agents:
        config = from_json("config", replay.config)
        open_ears, scripted = with_ears(config), scripted_places(config)
        listeners = [
            agent.name for k, agent in enumerate(replay.agents) if open_ears[k] or not scripted[k]
        ]
        agents = RecordedAgents(recording, camera, listeners)
        for moment in replay.play(house=house):
            agents.step(moment.step, moment.world, moment.agents)
        agents.finish()
        return
    recording.text("instruction", replay.instruction)
    way = []
    for moment in replay.play(house=house):
        agent = moment.world.agents()[0]
        way.append(agent["position"])
        image = moment.world.render(agent=0, camera=camera)["rgb"]
        recording.step(moment.step, agent, image, camera)
    recording.way("replay", way)


def _listener(source: Sequence[float], rooms: Sequence[Mapping[str, Any]]) -> list[float]:
    """Ears in the middle of the room whose middle is nearest."""

    def distance(room: Mapping[str, Any]) -> float:
        return math.dist(room["stand"], source)

    x, y, z = min(rooms, key=distance)["stand"]
    return [x, y + _EAR_M, z]
