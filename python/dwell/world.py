"""Worlds: a state that changes, over a shared house."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError, _native
from dwell.action_api import ActionApi
from dwell.agent_controls import controls_of
from dwell.arguments import (
    finite_number,
    integer_in_range,
    mapping,
    number_in_range,
    point,
    quoted,
    text,
    text_list,
    three_numbers,
    to_json,
    two_numbers,
)
from dwell.body_api import BodyApi
from dwell.camera import MAX_PIXELS, Camera, camera_settings
from dwell.configs import bodies
from dwell.engine_types import Channel
from dwell.guide_api import GuideApi
from dwell.heads import Head
from dwell.house import House
from dwell.navigation import Navigation, Walker, walker_settings
from dwell.outside_rooms import warn_outside_rooms
from dwell.person_api import PersonApi
from dwell.sound_api import SoundApi
from dwell.world_settings import Laws, Randomize, file_of_laws_named, with_head, world_settings

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from dwell.engine_types import BodySettings, WorldSettings

#: How steeply an agent looks up or down at most, the engine's 1.5 rad.
_STEEPEST_DEG = 85.9
#: The attributes that a pickle's arguments make again.
_OWN = ("house", "_native", "_config", "_seed", "_heads")
#: Ids have 32 bits.
_MAX_ID = 2**32 - 1


class World(ActionApi, BodyApi, GuideApi, PersonApi, SoundApi):
    """A running world with its own state over a shared house.

    A copy, or what comes out of a pickle, goes on from the moment it was made.
    """

    def __init__(
        self,
        house: House | str,
        *,
        agents: int | Sequence[BodySettings] = 1,
        seed: int = 0,
        laws: Laws = None,
        parameters: Mapping[str, float] | None = None,
        randomize: Randomize = None,
        **config: Unpack[WorldSettings],
    ) -> None:
        """Makes a world.

        Args:
            house: A house or a HOUSE string.
            agents: How many agents live in it, all of the default body. Each is seen as a capsule
                by others and by cameras that are not its own; pictures of a house want 0. Or a body
                for each, as a mapping of what differs: ``kind`` (``"person"``: it is seen as a
                jointed person, see :meth:`set_gesture`; then also ``hand`` and ``colors``),
                ``radius_m``, ``height_m``,
                ``eye_height_m``, ``step_height_m``, ``max_slope_rad``, ``lift_kg``, ``reach_m``,
                ``push_force_n``, ``hand_effort``, ``max_carry_size_m``, ``camera_fov_deg`` and
                ``locomotion``, which is ``{"walking": {...}}`` (``max_speed_m_s``,
                ``max_crouched_speed_m_s``, ``crouched_height_m``), ``{"differential_drive":
                {...}}`` (``wheel_base_m``, ``left_wheel_radius_m``, ``right_wheel_radius_m``,
                ``max_wheel_speed_rad_s``, ``max_wheel_acceleration_rad_s2``) or ``{"holonomic":
                {...}}`` (``max_forward_m_s``, ``max_sideways_m_s``, ``max_yaw_rate_rad_s``,
                ``max_acceleration_m_s2``, ``max_yaw_acceleration_rad_s2``).
            seed: The seed of everything random.
            laws: Laws to install: a name, ``{name: {parameter: value}}``, or a list of names and of
                ``{"id", "version", "target", "params"}`` (``docs/laws.md``); or what calibration
                found (laws and parameters), as a mapping or as the path of its ``found.json``.
                ``None`` and what is empty install none.
            parameters: Values by address, such as ``{"world/gravity_m_s2": 1.62}``; they go before
                those that calibration found. What ``randomize`` draws is not stated, too.
            randomize: Intervals from which ``seed`` draws, evenly: ``{address: [low, high]}``; or
                what calibration found, as a mapping or as the path of its ``found.json``, which is
                installed, too.
            **config: ``control_rate_hz``, ``physics_rate_hz``, ``sound_rate_hz``, ``sound_preset``,
                ``sound_root`` (the folder below which sound files are), ``sound_head`` (a
                :class:`dwell.Head` or the path of its SOFA file: on it are all ears), ``settle_s``
                (how long things may come to rest before the world begins; else they fall by the
                hair that is between them within its first second), and
                ``renderer``, who makes pictures: ``"cpu"`` (default, or what the variable
                DWELL_RENDERER says), ``"gpu"``, or ``"gpu:NAME"`` with a part of an adapter's name.
        """
        self.house = house if isinstance(house, House) else House.open(house)
        further, self._heads = with_head(config)
        for head in self._heads:
            self.house.native.add_head(head.native)
        settings = {
            "agents": bodies(agents),
            **world_settings(laws, parameters, further, randomize),
        }
        self._config, self._seed = to_json(settings), integer_in_range("seed", seed)
        with file_of_laws_named(laws):
            self._native = _native.World(self.house.native, self._config, self._seed)
        for agent in self.agents():
            warn_outside_rooms(self.house, "an agent", agent["position"])

    @classmethod
    def _rebuild(
        cls, house: House, config: str, seed: int, heads: tuple[Head, ...], snapshot: bytes
    ) -> World:
        """The world of a pickle, in its state."""
        world = cls.__new__(cls)
        world.house, world._config, world._seed, world._heads = house, config, seed, heads
        for head in heads:
            house.native.add_head(head.native)
        world._native = _native.World(house.native, config, seed)
        world.restore(snapshot)
        return world

    @classmethod
    def of_env(cls, house: House, native: _native.World) -> World:
        """The world of an environment, which goes on stepping it; tasks in Python are given it."""
        world = cls.__new__(cls)
        world.house, world._native, world._heads = house, native, ()
        world._config, world._seed = to_json(native.config()), 0
        return world

    def __reduce__(self) -> tuple[Any, tuple[Any, ...], dict[str, Any]]:
        """House, settings, heads and a snapshot; and what else a subclass holds."""
        again = (self.house, self._config, self._seed, self._heads, self.snapshot())
        own = {name: value for name, value in vars(self).items() if name not in _OWN}
        return type(self)._rebuild, again, own

    def __repr__(self) -> str:
        """The house, the time, and the number of agents."""
        agents = len(self.agents())
        return f"World({self.house.name!r}, time_s={self.time_s:g}, agents={agents})"

    @property
    def native(self) -> _native.World:
        """The built half."""
        return self._native

    @property
    def time_s(self) -> float:
        """Simulated time, s."""
        return self._native.time_s

    @property
    def sound_rate_hz(self) -> int:
        """Samples a second of what is heard."""
        return int(self._native.config()["sound_rate_hz"])

    @property
    def samples_a_step(self) -> int:
        """Samples of sound in a control step."""
        config = self._native.config()
        return int(config["sound_rate_hz"] // config["control_rate_hz"])

    def step(
        self,
        controls: NDArray[np.float32]
        | Sequence[Sequence[float]]
        | Sequence[Mapping[str, Any]]
        | None = None,
    ) -> None:
        """Makes one control step.

        Args:
            controls: Shape (agent, 4): forward m/s, right m/s, yaw rad/s (positive to the left),
                pitch rad/s (positive up). Legs have these velocities at once, running up to their
                ``max_speed_m_s``; wheels go towards them as fast as they accelerate. Or a mapping
                for each agent with ``forward_m_s``, ``right_m_s``, ``yaw_rate_rad_s``,
                ``pitch_rate_rad_s``; ``wheel_rad_s`` (left, right) of a differential drive instead
                of velocities; ``crouch`` of legs. Agents without one stand still, and so does
                everybody for ``None``.

        Raises:
            ConfigError: For a field that does not exist.
            DwellError: For numbers that are not finite, more controls than agents, or what the
                agent's body cannot do. Nothing has happened then.

        Examples:
            >>> import dwell
            >>> robot = {"locomotion": {"differential_drive": {"wheel_base_m": 0.4}}}
            >>> world = dwell.World("builtin:apartment", agents=[robot])
            >>> world.step([{"wheel_rad_s": (4.0, 4.0)}])
            >>> world.agents()[0]["base"]["wheel_rad_s"][0] > 0.0
            True
        """
        if controls is None:
            controls = np.zeros((len(self.agents()), 4), np.float32)
        rows = controls_of(controls)
        if isinstance(rows, np.ndarray):
            self._native.step(rows)
        else:
            self._native.step_fields(rows)

    def place_agent(
        self,
        position: Sequence[float],
        yaw_deg: float = 0.0,
        *,
        agent: int = 0,
        pitch_deg: float = 0.0,
        linear_m_s: Sequence[float] = (0.0, 0.0, 0.0),
        yaw_rate_rad_s: float = 0.0,
        crouched_by_m: float = 0.0,
        wheel_rad_s: Sequence[float] | None = None,
    ) -> None:
        """Places an agent, moving in any way that its body can; at rest by default.

        Legs slide or fly on with a velocity until feet brake them: what they do by their own will
        they are told in :meth:`step`. Wheels turn as the velocity ahead and the rate of turn ask
        for. :meth:`agents` reads back what was set.

        Args:
            position: The point between its feet, m.
            yaw_deg: Where it faces, degrees, positive to the left.
            agent: Which one.
            pitch_deg: Where it looks, degrees, positive up; up to 85 either way.
            linear_m_s: Its velocity, up to 30 m/s along each axis.
            yaw_rate_rad_s: Its rate of turn, positive to the left.
            crouched_by_m: How much lower than its height legs keep it.
            wheel_rad_s: Speeds of the left and right wheel of a differential drive, instead of a
                level velocity and a rate of turn.

        Raises:
            ConfigError: For what is no finite number, and an agent that there is not.
            DwellError: Its body cannot have the numbers. Nothing has changed then.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment")
            >>> room = world.house.rooms()[0]
            >>> world.place_agent(room["stand"], pitch_deg=-20.0, linear_m_s=(0.5, 0.0, 0.0))
            >>> world.agents()[0]["velocity"]
            [0.5, 0.0, 0.0]
        """
        place = point("position", position)
        row = {
            "position": place,
            "yaw_deg": finite_number("yaw_deg", yaw_deg),
            "pitch_deg": number_in_range(
                "pitch_deg", pitch_deg, -_STEEPEST_DEG, _STEEPEST_DEG, "degrees"
            ),
            "linear_m_s": three_numbers("linear_m_s", linear_m_s),
            "yaw_rate_rad_s": finite_number("yaw_rate_rad_s", yaw_rate_rad_s),
            "crouched_by_m": finite_number("crouched_by_m", crouched_by_m),
            "wheel_rad_s": None if wheel_rad_s is None else two_numbers("wheel_rad_s", wheel_rad_s),
        }
        self._native.place_agent(integer_in_range("agent", agent), row)
        warn_outside_rooms(self.house, "an agent", place)

    def events(self) -> list[dict[str, Any]]:
        """The contacts of the last step: impacts, scrapes and rolling.

        Each has kind, phase, time_s, duration_s, position, a, b, substance_a, substance_b,
        impulse_n_s, tangential_impulse_n_s, relative_normal_speed_m_s,
        relative_tangential_speed_m_s, rolling_speed_m_s.
        """
        return self._native.events()

    def render(
        self,
        *,
        agent: int | None = None,
        position: Sequence[float] | None = None,
        yaw_deg: float = 0.0,
        pitch_deg: float = 0.0,
        camera: Camera | None = None,
        channels: Sequence[Channel] = ("rgb",),
    ) -> dict[str, NDArray[Any]]:
        """Renders a view from an agent's eyes, or from a position.

        What an agent carries obeys the laws of its cameras; a camera anywhere else is ideal.

        Args:
            agent: Whose eyes; 0 when no position is given.
            position: Where the camera is instead, m.
            yaw_deg: Where it looks there, positive to the left; only with a position.
            pitch_deg: Positive up; only with a position.
            camera: Size, projection, mount.
            channels: What to take.

        Returns:
            ``rgb`` (height, width, 3) uint8 sRGB; ``depth`` (height, width, 1) float32 m along -Z
            (range for fisheyes and cameras that see all around); ``instance`` and ``semantic``
            (height, width, 1) int32; in the camera's frame (right, up, back) ``normals`` (height,
            width, 3) float32 and ``surfels`` (height, width, 9) float32, position in m, normal,
            reflectance; ``albedo`` (height, width, 3) float32,
            linear reflectance 0 to 1; ``flow`` (height, width, 2) float32, pixels right and down
            since the step before; of what is in view, by id, unused rows 0: ``visible_objects``
            (max_objects, 3) float32, id, pixels, part hidden by others; ``boxes_2d`` (max_objects,
            6) int32, id, first column and row, those behind the last, pixels; ``boxes_3d``
            (max_objects, 11) float32, id, middle and edges in m, rotation x, y, z, w.

        Raises:
            ConfigError: An agent and a position are given, or angles for an agent's eyes, which
                :meth:`place_agent` turns; a camera, place or channel that there is not.
        """
        chosen = Camera() if camera is None else camera
        view: dict[str, Any] = {"camera": camera_settings("camera", chosen)}
        if position is not None and agent is not None:
            raise ConfigError("agent, position: found both; expected one of them")
        if position is None:
            for name, angle_deg in (("yaw_deg", yaw_deg), ("pitch_deg", pitch_deg)):
                if finite_number(name, angle_deg) != 0.0:
                    raise ConfigError(
                        f"{name} is {angle_deg:g} without a position; an agent's eyes look where "
                        "it does: turn it (place_agent), or its camera (Camera.yaw_deg, pitch_deg)"
                    )
            view["agent"] = 0 if agent is None else integer_in_range("agent", agent)
        else:
            place = point("position", position)
            view["position"] = list(place)
            warn_outside_rooms(self.house, "a camera", place)
            view["yaw_deg"] = finite_number("yaw_deg", yaw_deg)
            view["pitch_deg"] = finite_number("pitch_deg", pitch_deg)
        return self._native.render(view, text_list("channels", channels))

    def map(
        self, longest_edge: int = 512, *, level: int = 0
    ) -> tuple[NDArray[np.uint8], tuple[float, float], float]:
        """A storey from above, cut open below its ceilings; :mod:`dwell.plans` writes names on it.

        Args:
            longest_edge: Pixels of its longer edge, 1 to 16384.
            level: The storey, from 0.

        Returns:
            The image (height, width, 3), the x and z of its upper left corner in m, pixels a metre.

        Raises:
            DwellError: There is no such storey; a picture that the free memory cannot hold.
        """
        edge = integer_in_range("longest_edge", longest_edge, low=1, high=MAX_PIXELS)
        level = integer_in_range("level", level, high=_MAX_ID)
        image, x, z, scale = _native.map(self._native, level, edge)
        return image, (x, z), scale

    def navigation(self, walker: Walker | None = None) -> Navigation:
        """The navigation grid of the house as it stands now."""
        walks = walker_settings(walker)
        return Navigation(self.house, walks, self._native.navigation(walks))

    def merged_events(self) -> dict[str, Any]:
        """The events of the last step beyond its limit: count and impulse_n_s."""
        return self._native.merged_events()

    def listen(self, samples: int = 800, *, agent: int = 0) -> NDArray[np.float32]:
        """The newest samples at an agent's ears, (2, samples), Pa.

        From the first call until the next reset the agent listens, and each step adds what it
        hears; before that the window holds the last step's sound and zeros. Ears keep as much as
        the longest call so far asked for: who wants a second at the end asks for one at the start.
        Nothing that happens changes by it; :meth:`state_hash` holds the sound that ears keep, too.

        Args:
            samples: How many, 1 to ten seconds' worth.
            agent: Whose ears.
        """
        return self._native.listen(
            integer_in_range("agent", agent), integer_in_range("samples", samples, low=1)
        )

    def parameter(self, address: str) -> dict[str, Any]:
        """The parameter at an address: value, unit, low, high."""
        return self._native.parameter(text("address", address))

    def parameters(self, prefix: str = "") -> dict[str, dict[str, Any]]:
        """Every parameter by its address: value, unit, low, high.

        Args:
            prefix: What the addresses begin with, such as ``"law/"`` or ``"joint/"``.
        """
        rows = self._native.parameters()
        return {address: row for address, row in rows if address.startswith(text("prefix", prefix))}

    def set_parameter(self, address: str, value: float) -> None:
        """Sets a parameter from now on; it goes into snapshots and the hash.

        ``law/ID/PARAM`` is a number of a law that acts on all it can, ``law/ID@TARGET/PARAM`` of
        one on a target, ``law/N/PARAM`` of the law that was installed as number N. The first number
        that differs from its default installs a law; one whose numbers are all default acts no
        more.
        """
        self.set_parameters({text("address", address): value})

    def set_parameters(self, parameters: Mapping[str, float]) -> None:
        """Sets parameters together from now on: all of them, or none.

        What bounds each other is checked when all are set: the two limits of a joint, the three
        moments of inertia of a part, the height and the radius of an agent.

        Args:
            parameters: Values by address.

        Raises:
            ConfigError: For what is no finite number.
            SceneError: An address names nothing or stands there in two spellings, or a value is out
                of its range beside the others. Nothing has changed then.
            DwellError: An agent's new body has no room where it stands, or a law cannot act on its
                target. Nothing has changed then.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment")
            >>> child = {"height_m": 1.1, "eye_height_m": 0.95, "radius_m": 0.15, "reach_m": 1.0}
            >>> world.set_parameters({f"agent/0/body/{name}": x for name, x in child.items()})
            >>> world.agents()[0]["body"]["height_m"]
            1.1
        """
        rows = mapping("parameters", parameters, "values by address").items()
        self._native.set_parameters(
            [(address, finite_number(address, value)) for address, value in rows]
        )

    def snapshot(self) -> bytes:
        """The whole world as bytes; no mesh is in them."""
        return self._native.snapshot()

    def restore(self, snapshot: bytes) -> None:
        """Restores a snapshot; the next steps give the same bits as then."""
        if not isinstance(snapshot, bytes):
            raise ConfigError(f"snapshot is {quoted(snapshot)}; expected the bytes of snapshot()")
        self._native.restore(snapshot)

    def state_hash(self) -> int:
        """A number that changes with any bit of state, physics, sound queues or random streams."""
        return self._native.hash()


def actions() -> list[str]:
    """The discrete actions, in the order of their numbers."""
    return _native.actions()
