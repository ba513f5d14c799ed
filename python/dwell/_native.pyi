"""The built half of dwell: conversions only. Structured values cross as they are or as JSON text, arrays as NumPy arrays.

Every function releases the GIL while the engines work, raises subclasses of ``DwellError``, and turns a bug of the
engines into ``EngineBug`` instead of taking the process down.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias, final

import numpy as np
from numpy.typing import NDArray
from typing_extensions import Self

#: Mappings, lists, text and numbers.
_Data: TypeAlias = Mapping[str, Any] | Sequence[Any]
_Rows: TypeAlias = list[dict[str, Any]]
_Id: TypeAlias = str | int
_Names: TypeAlias = Sequence[str] | None

__all__ = [
    "AcousticScene",
    "Batch",
    "ConfigError",
    "DwellError",
    "EngineBug",
    "Hdf5",
    "Head",
    "House",
    "HouseError",
    "HouseFileError",
    "HouseNotFoundError",
    "MeasuredDataError",
    "Navigation",
    "PreparedEnv",
    "SceneError",
    "StopToken",
    "UsageError",
    "World",
    "__version__",
    "action_table",
    "actions",
    "bench",
    "builtin_names",
    "calibrate",
    "calibration_example",
    "charset",
    "check_measured",
    "chosen_actions",
    "doctor",
    "dollhouse",
    "ear_metrics",
    "fixtures",
    "floor_plan",
    "furniture_kinds",
    "json_size_bounds",
    "language_read",
    "language_say",
    "laws",
    "map",
    "max_text_length",
    "object_class",
    "object_classes",
    "predicates_json",
    "prepared_envs",
    "response_metrics",
    "seed_range",
    "sensors",
    "settings",
    "signals",
    "surfaces",
    "synthesize",
    "tasks",
    "texture",
    "vocabulary",
    "vocal_efforts",
    "world_answers",
    "world_attributes",
    "world_check_text",
    "world_color_names",
    "world_graph_json",
    "world_heard",
    "world_holds",
    "world_judge_text",
    "world_person_hand",
    "world_person_joints",
    "world_refer",
    "world_relation_array",
    "world_relations",
    "world_say",
    "world_select",
    "world_set_gesture",
    "world_speaks",
    "world_view_words",
]

__version__: str

class DwellError(Exception): ...
class SceneError(DwellError, ValueError): ...
class HouseError(DwellError, ValueError): ...
class HouseFileError(HouseError, OSError): ...
class HouseNotFoundError(HouseError, FileNotFoundError): ...
class ConfigError(DwellError, ValueError): ...
class UsageError(DwellError, RuntimeError): ...
class MeasuredDataError(DwellError, ValueError): ...
class EngineBug(DwellError, RuntimeError): ...

@final
class StopToken:
    """Stops calls of threads that hear no signals, such as those of a pool."""

    def __new__(cls) -> StopToken: ...
    def watch_this_thread(self) -> None:
        """From now on the calls of the thread that calls this are stopped."""
    def stop(self) -> None:
        """Stops the calls of the threads that watch; each raises ``KeyboardInterrupt`` there."""

@final
class Hdf5:
    """An HDF5 file that is read, itself alone: links and values elsewhere are refused."""

    @staticmethod
    def open(path: str) -> Hdf5: ...
    def shape(self, name: str) -> list[int] | None:
        """The lengths of a variable's axes; ``None`` where there is no such variable."""
    def text(self, variable: str | None, name: str) -> str | None:
        """The text of an attribute of a variable, or of the file; ``None`` where there is none."""
    def numbers(self, name: str) -> tuple[NDArray[np.float64], list[int]]:
        """A variable's numbers, the last axis first, and the lengths of its axes."""

@final
class Head:
    """A head that receivers and agents can wear."""

    @staticmethod
    def spherical(radius_m: float) -> Head: ...
    @staticmethod
    def measured(
        sources: NDArray[np.float64],
        responses: NDArray[np.float32],
        rate_hz: float,
        delays: NDArray[np.float64],
    ) -> Head:
        """Shapes (direction, 3), m in head space; (direction, 2, sample); (direction, 2), samples."""
    @property
    def id(self) -> int: ...
    def summary(self) -> dict[str, Any] | None:
        """``{directions, filled, radius_m, gain_db, removed_delay_s}``, or ``None`` for a sphere."""

@final
class House:
    """A checked, immutable house, shared by everything that is made from it."""

    @staticmethod
    def open(house: str, threads: int | None = ...) -> House: ...
    @staticmethod
    def built(plan_json: str) -> House:
        """The house of a plan."""
    def edited(self, edits_json: str) -> House:
        """The same house with edits."""
    def map_template(self, house: str) -> str:
        """A map file for what stayed unmapped; ``house`` stands in its head."""
    @staticmethod
    def shoebox(
        size_m: tuple[float, float, float],
        substance: str | None = ...,
        absorption: float | None = ...,
        scattering: float | None = ...,
    ) -> House: ...
    def with_robot(
        self,
        path: str,
        name: str,
        position: tuple[float, float, float],
        yaw_deg: float = ...,
        fixed_base: bool | None = ...,
    ) -> House:
        """A house with the robot of a ``.urdf`` or MuJoCo ``.xml`` in it; meshes are shared."""
    def add_head(self, head: Head) -> None:
        """Agents of worlds over this house may wear it; ``sound_head`` in their config names it."""
    @property
    def name(self) -> str: ...
    @property
    def counts(self) -> tuple[int, int]:
        """Rooms and objects."""
    def is_outside(self, point: tuple[float, float, float]) -> bool:
        """Returns whether a point lies in no room; in a house without rooms: beyond all walls."""
    def room_at(self, point: tuple[float, float, float]) -> str | None:
        """The name of the room around a point."""
    def same(self, other: House) -> bool:
        """Returns whether the other holds the same in all tables, meshes and images."""
    def fingerprint(self) -> int:
        """The same number for houses that hold the same; 64 bits."""
    def info(self) -> dict[str, Any]:
        """Counts, rooms, objects, categories, report of damage: one JSON object."""
    def describe(self, level: str, options: tuple[str, str, int | None]) -> list[dict[str, Any]]:
        """Sentences, or JSON lines, of one level: object, room, house, graph, instructions."""
    def semantic_classes(self, table: str = ...) -> list[str]:
        """Names of semantic classes: ``coarse``, ``fine`` or ``nyu40``; 0 is void."""
    def rooms(self) -> list[dict[str, Any]]:
        """For each room: name, kinds, area, centre of a good view: ``{name, kinds, area_m2, floor_y, eye, yaw_deg}``."""
    def write_into(self, root: str, name: str, form: str) -> tuple[Path, list[str]]: ...
    @staticmethod
    def finish_folder(root: str, form: str) -> None: ...
    def write(self, path: str, form: str) -> list[str]:
        """Writes the house as ``dwell`` or ``suncg`` and returns what was lost, a sentence each."""

@final
class Navigation:
    """The navigation grid of a house as it stands at one moment."""

    def __new__(cls, house: House, walker: _Data, state: bytes | None = ...) -> Self: ...
    def state(self) -> bytes | None:
        """The state of the house, as the constructor takes it; ``None``: as the house starts."""
    def points(self, start: tuple[float, float, float] | None = ...) -> NDArray[np.float32]:
        """Places to stand, (n, 3), m; with ``start``: those to which a way leads from there."""
    def islands(self, points: Sequence[tuple[float, float, float]]) -> list[int | None]: ...
    def sample(
        self, seed: int, count: int = ..., start: tuple[float, float, float] | None = ...
    ) -> NDArray[np.float32]: ...
    def route(
        self, start: tuple[float, float, float], goal: tuple[float, float, float]
    ) -> tuple[NDArray[np.float32], float, list[str]] | None:
        """Corners (n, 3), length in m, the shut doors on the way."""
    def occupancy(self, level: int) -> tuple[NDArray[np.uint8], float, float, float]:
        """Free cells (depth, width), x and z of the corner, edge of a cell in m."""
    def doors(self) -> list[dict[str, Any]]: ...

@final
class World:
    """A running world with its own state over a shared house."""

    def __new__(cls, house: House, config_json: str = ..., seed: int = ...) -> Self: ...
    @staticmethod
    def of_env(batch: Batch, env: int) -> World:
        """The world of environment ``env`` of a batch, which both go on to use."""
    def step(self, controls: NDArray[np.float32]) -> None:
        """One control step; ``controls``: shape (agent, 4): forward m/s, right m/s, yaw rad/s (positive to the left), pitch rad/s (positive up)."""
    def step_fields(self, controls: _Data) -> None:
        """One control step; ``[{"forward_m_s": 1.0, ...}, ...]``, the fields of the native ``AgentControl``."""
    def act(self, agent: int, action: _Data) -> dict[str, Any]:
        """``{"kind": "pick", "object": "mug_1"}`` and kin; answers ``{success, code, sentence, object, pointed}``."""
    def delayed_outcomes(self) -> list[dict[str, Any]]:
        """``[{agent, outcome}, ...]``: what became, in the last step, of actions that take time."""
    def config(self) -> dict[str, Any]:
        """The settings, all of them, as the constructor reads them."""
    def place_agent(self, agent: int, place: _Data) -> None:
        """``{position, yaw_deg, pitch_deg, linear_m_s, yaw_rate_rad_s, crouched_by_m, wheel_rad_s}``."""
    def agents(self) -> list[dict[str, Any]]: ...
    def objects(self) -> list[dict[str, Any]]:
        """Id, name, category, position, room, held, on, openness of every object now."""
    def object(self, named: str | int) -> dict[str, Any]:
        """The same of one object, by its name or id."""
    def events(self) -> list[dict[str, Any]]: ...
    def start_report(self) -> dict[str, Any]: ...
    def render(self, view: _Data, channels: Sequence[str]) -> dict[str, NDArray[Any]]:
        """``view``: ``{camera, position, yaw_deg, pitch_deg | forward}`` or ``{camera, agent}``."""
    def listen(self, agent: int, samples: int) -> NDArray[np.float32]:
        """The newest samples at an agent's ears, shape (2, samples), Pa. Call once after each step, for each agent that listens."""
    def play(self, sound: _Data) -> int:
        """``{sound: {signal | file: name}, at: {position | object | agent: ...}, level_db, loops}``."""
    def stop_sound(self, handle: int) -> None: ...
    def start_sound(self, handle: int) -> None: ...
    def set_sound_level(self, handle: int, level_db: float) -> None: ...
    def sounds(self) -> list[dict[str, Any]]:
        """``[{handle, sound, position, level_db, loops, on, object}, ...]``."""
    def navigation(self, walker: _Data) -> Navigation: ...
    def follow(self, navigation: Navigation) -> int:
        """Brings a grid up to date with what has moved; returns how many columns were looked at."""
    def merged_events(self) -> dict[str, Any]: ...
    def path(
        self, agent: int, goal: tuple[float, float, float]
    ) -> list[tuple[float, float, float]] | None: ...
    def guide(self, agent: int, goal: tuple[float, float, float]) -> int | None:
        """The next discrete action on the way to a point, doors opened on the way; None on arrival."""
    def act_discrete(self, agent: int, action: int) -> dict[str, Any]:
        """One control step of a discrete action with default strides; answers as :meth:`act`."""
    def face(self, agent: int, object: str) -> int | None:
        """The discrete turn or nod that brings an object into view; None when it is."""
    def gaze_target(self, agent: int) -> str | None: ...
    def joints(self) -> list[dict[str, Any]]:
        """Every joint: ``{id, name, object, kind, limits, motor, position, velocity, command}``."""
    def command_joint(self, joint: int, kind: str, value: float) -> None:
        """``kind``: off, position (rad or m), velocity, effort (N m or N)."""
    def set_joints(self, joints: Sequence[tuple[int, float, float]]) -> None:
        """Puts joints (id) to a position and a velocity at once."""
    def body(self, object: str, part: str | None) -> dict[str, list[float]]: ...
    def set_bodies(self, bodies: _Data) -> None: ...
    def parameter(self, address: str) -> dict[str, Any]: ...
    def parameters(self) -> list[tuple[str, dict[str, Any]]]: ...
    def set_parameters(self, values: Sequence[tuple[str, float]]) -> None:
        """All of them, or none."""
    def describe(
        self,
        level: str,
        options: tuple[str, str, int | None],
        viewer: _Data | int | None,
        agent: int | None = ...,
        to: str | int | None = ...,
        since: bytes | None = ...,
    ) -> list[dict[str, Any]]: ...
    def snapshot(self) -> bytes: ...
    def restore(self, snapshot: bytes) -> None: ...
    def hash(self) -> int: ...
    @property
    def time_s(self) -> float: ...
    @property
    def step_count(self) -> int: ...

@final
class Batch:
    """Environments stepped together; observations are written into arrays of the caller.

    In each the same agents act; ``agent`` is the place of one among them. Arrays of environments and
    agents are flat, the agents of an environment one after the other.
    """

    def __new__(
        cls,
        houses: Sequence[House],
        config_json: str,
        threads: int | None = ...,
        overlap: bool = ...,
    ) -> Self: ...
    def agents(self) -> list[int]:
        """Who acts in every environment, by the number among the world's agents."""
    def sensor_agents(self) -> list[int]:
        """Whose each sensor is."""
    def specs(self) -> list[dict[str, Any]]:
        """``[{name, shape, dtype, unit, low, high, about}, ...]``, one for each sensor: those of the first agent, of the second, and so on."""
    def reset(
        self,
        seeds: Sequence[int | None],
        stated: Sequence[Mapping[str, Any] | None] | None = ...,
    ) -> None:
        """Begins the episodes of seeds, ``None``: goes on; ``stated``: ``{start, goal}`` of those that state them."""
    def replace_env(self, env: int, spare: PreparedEnv) -> None:
        """``spare`` takes the place of environment ``env``, once; worlds of :meth:`World.of_env` are its from then on."""
    def steps(self) -> NDArray[np.int64]:
        """Number of steps of each environment's episode so far."""
    def step(
        self,
        actions: NDArray[np.int64],
        velocities: NDArray[np.float32] | None = ...,
        places: NDArray[np.float32] | None = ...,
        objects: NDArray[np.int64] | None = ...,
        answers: NDArray[np.float32] | None = ...,
        tokens: NDArray[np.int64] | None = ...,
        efforts: NDArray[np.int64] | None = ...,
        questions: NDArray[np.int64] | None = ...,
    ) -> dict[str, NDArray[Any] | list[str]]:
        """``actions``: for each environment and agent; -1 for all agents: that environment is not stepped. Of an agent whose episode has ended none is looked at. Keys: reward, terminated, success, action_success, collision, distance_to_goal (NaN without a goal), spl, soft_spl, path_length, collisions (arrays of that shape) and action_error (list). ``velocities``: forward, right, turn, look, -1 to 1, flat; ``places``: of pictures, 0 to 1, flat; ``objects``: ids, 0 for what is looked at; ``tokens``: what agents begin to say, numbers of words up to the first 0, (row x 8,), with ``efforts``, numbers of :func:`vocal_efforts`; ``questions``: what they ask oracles, (row x 16,). Of tasks with an oracle ``reply`` (list), empty where nothing was asked."""
    def answer_fields(self, agent: int = 0) -> list[dict[str, Any]]:
        """``[{name, about, unit, range, choices}, ...]``: what an agent's task expects with ``stop``."""
    def measures(self, agent: int = 0) -> list[str]:
        """Names of what an agent's task measures beside distance and path; keys of what ``step`` gives."""
    def expert_answers(self) -> NDArray[np.float32]:
        """For each environment and agent all the fields that an answer can have, flat."""
    def expert_utterances(self) -> NDArray[np.int64]:
        """For each environment and agent 8 numbers of words, 0 for none, flat."""
    def expert_questions(self) -> NDArray[np.int64]:
        """For each environment and agent 16 numbers of words, 0 for none, flat."""
    def takes_questions(self, agent: int = 0) -> bool:
        """Whether an agent's task has an oracle that takes questions."""
    def action_masks(self) -> NDArray[np.bool_]:
        """For each environment and agent, which discrete actions nothing known beforehand rules out, flat."""
    def observe(self, which: NDArray[np.bool_], outs: Sequence[NDArray[Any] | None]) -> None:
        """``outs``: one C-contiguous array (n, *shape) for each sensor, None for text."""
    def texts(self, sensor: int) -> list[str]: ...
    def render(self, env: int, view: _Data) -> NDArray[np.uint8]:
        """What environment ``env``'s first agent sees, lit; ``view``: as :meth:`World.render`."""
    def instruction(self, env: int, agent: int = ...) -> str: ...
    def episode_goal(self, env: int, agent: int = ...) -> dict[str, Any]: ...
    def set_goal(
        self,
        env: int,
        instruction: str | None = ...,
        distance_m: float | None = ...,
        agent: int = ...,
    ) -> None:
        """Asks something else (``None``: the same) of the episode that has just begun; the agent starts where it stands."""
    def set_step_result(self, env: int, ruling: _Data, agent: int = ...) -> dict[str, Any]:
        """Judges the latest step anew: ``{reward, terminated, success, distance_m}``; gives ``{distance_to_goal, spl, soft_spl}``; ``None`` without a goal."""
    def expert_actions(self) -> NDArray[np.int64]:
        """For each environment and agent."""
    def expert_action(self, env: int, agent: int = ...) -> int: ...
    def state_hash(self, env: int) -> int: ...
    def snapshot(self, env: int) -> bytes:
        """World and episode of one environment."""
    def restore(self, env: int, snapshot: bytes) -> None: ...
    def clipped(self) -> list[int]:
        """For each environment and agent, samples of sound that its latest observation cut off."""
    def agent_states(self, env: int) -> list[dict[str, Any]]:
        """The states of all agents of a world, whether they act or not."""
    def __len__(self) -> int: ...

@final
class PreparedEnv:
    """An environment that waits for its place in a batch."""

@final
class AcousticScene:
    """Impulse responses in a house as it starts."""

    def __new__(
        cls,
        house: House,
        config: _Data,
        laws: _Data,
        parameters: _Data,
    ) -> Self: ...
    def impulse_responses(
        self,
        source: _Data,
        receivers: _Data,
        *,
        heads: Sequence[Head],
        seed: int = ...,
        threads: int | None = ...,
    ) -> list[NDArray[np.float32]]:
        """Shape (channels, samples) each: pressure in Pa for a source of 1 Pa at 1 m; the first sample is time zero."""
    def metrics(
        self,
        source: _Data,
        receivers: _Data,
        *,
        seed: int = ...,
        threads: int | None = ...,
    ) -> list[list[dict[str, Any]]]:
        """For each receiver and band: centre_hz and EDT, T20, T30, C50, C80, D50, Ts, G, DRR, LF."""
    def echogram(
        self,
        source: _Data,
        receiver: _Data,
        *,
        seed: int = ...,
        threads: int | None = ...,
    ) -> dict[str, Any]:
        """``{paths, tail: {bin_s, bins, bins_per_direction, directions}, direct_length_m, speed_m_s, ray_statistics}``."""
    def early_paths(self, source: _Data, mic: tuple[float, float, float]) -> list[dict[str, Any]]:
        """``[{points, path: {planes, diffraction_points, length_m, energy, arrival, departure, walls}}, ...]``, by length."""
    def material_report(self) -> dict[str, Any]: ...
    def config(self) -> dict[str, Any]:
        """The fields of ``AcousticConfig``, with the air as laws make it."""
    @property
    def rate_hz(self) -> int: ...

def prepared_envs(
    houses: Sequence[House],
    config_json: str,
    seeds: Sequence[int | None],
    threads: int | None = ...,
    stated: Sequence[Mapping[str, Any] | None] | None = ...,
) -> list[PreparedEnv]:
    """An environment over each house, with the episode of its seed begun where it has one; ``stated``: as of :meth:`Batch.reset`."""

def actions() -> list[str]: ...
def chosen_actions(config_json: str, agent: int = 0) -> list[str]:
    """The discrete actions that an agent chooses from under settings of an environment, in the order of their numbers."""

def action_table() -> dict[str, list[dict[str, Any]]]:
    """``{kinds: [{name, about, is_of_hand, target, fields}], target: [{name, about, required, schema}], codes}``."""

def tasks() -> list[dict[str, Any]]: ...
def sensors() -> list[dict[str, Any]]: ...
def settings() -> dict[str, list[dict[str, Any]]]:
    """``{type: [{name, about, required, schema}]}``: the fields of settings."""

def laws() -> list[dict[str, Any]]: ...
def vocabulary() -> list[str]: ...
def charset() -> str: ...
def furniture_kinds() -> dict[str, str]: ...
def object_class(word: str) -> str | None:
    """The class that a word stands for: its name, an alias, or a word that is spoken for it alone."""

def object_classes() -> list[str]: ...
def json_size_bounds(text: bytes) -> tuple[int, int]: ...
def max_text_length() -> int: ...
def builtin_names() -> list[str]: ...
def doctor() -> dict[str, Any]: ...
def seed_range(house: str) -> tuple[int, int, str] | None: ...
def response_metrics(
    samples: NDArray[np.float32], rate_hz: float, width: _Data
) -> list[dict[str, float | None]]:
    """For each band: centre_hz and EDT, T20, T30, C50, C80, D50, Ts, G, DRR. ``width``: octave or third_octave."""

def ear_metrics(
    left: NDArray[np.float32], right: NDArray[np.float32], rate_hz: float, width: _Data
) -> dict[str, Any]:
    """``{itd_s, ild_db, bands: [{centre_hz, iacc_early, iacc_late, iacc, itd_s, ild_db}, ...]}``."""

def synthesize(signal: str, rate_hz: int, samples: int) -> NDArray[np.float32]: ...
def signals() -> list[dict[str, Any]]:
    """``[{name, description, loop_s, usual_level_db, level_source}, ...]``."""

def calibrate(
    measured: str,
    house: str | None = ...,
    progress: Any | None = ...,
    peers: Sequence[str] = ...,
    budget_s: float | None = ...,
) -> str:
    """Reads a measured bundle and answers the report as one JSON object."""

def calibration_example(folder: str, seed: int = ...) -> str:
    """Writes a small measured bundle with a hidden effect for demos; answers what was hidden."""

def check_measured(measured: str) -> int:
    """Reads and checks a measured bundle; answers how many episodes it has."""

def vocal_efforts() -> list[str]:
    """Names of vocal efforts, the quietest first."""

def world_heard(world: World, agent: int) -> list[dict[str, Any]]:
    """``[{speaker, token, direction, level_db, sti}]``: what was understood in the last step."""

def world_person_hand(world: World, agent: int) -> str: ...
def world_person_joints(world: World, agent: int) -> dict[str, list[float]]: ...
def world_set_gesture(world: World, agent: int, gesture: _Data) -> None: ...
def world_say(world: World, agent: int, words: str | _Data, effort: str) -> bool:
    """Numbers of words, or a text of them; whether the agent says it."""

def world_speaks(world: World, agent: int) -> bool: ...
def world_holds(
    world: World, name: str, things: Sequence[str | int], viewer: object
) -> tuple[bool | None, str | None]:
    """Whether a predicate holds, ``None`` where it is undecided, and why it is."""

def world_select(
    world: World,
    name: str,
    things: Sequence[str | int],
    n: int,
    reference: str | int | None,
    viewer: object,
) -> tuple[str | None, str | None]:
    """The n-th of things in an order, ``None`` where it is undecided, and why it is."""

def world_relations(world: World, names: _Names, viewer: object) -> list[tuple[str, str, str]]: ...
def world_relation_array(world: World, names: _Names, viewer: object) -> NDArray[np.int32]: ...
def world_attributes(world: World, named: str | int) -> dict[str, object]: ...
def world_color_names(world: World, named: _Id, vocabulary: int) -> list[tuple[str, float]]: ...
def world_graph_json(world: World, viewer: object) -> str: ...
def language_read(text: str) -> list[dict[str, Any]]:
    """The forms of a sentence, the preferred one first."""

def language_say(form: Mapping[str, Any], seed: int | None) -> str | None:
    """A form in English; ``None`` where there are no words for it."""

def world_refer(world: World, named: _Id, viewer: object, strategy: str, seed: int | None) -> _Rows:
    """The words by which a listener finds an object; none where no words do."""

def world_check_text(world: World, text: str, viewer: object, agent: int | None) -> dict[str, Any]:
    """A sentence read, checked and grounded."""

def world_judge_text(
    world: World, text: str, viewer: object, agent: int | None, of_view: bool
) -> list[dict[str, Any]]:
    """The claims of a text, each with its verdict; with ``of_view`` of what is seen alone."""

def world_answers(
    world: World, forms: Sequence[object], viewer: object, agent: int | None, seed: int | None
) -> list[dict[str, Any] | None]:
    """For each form ``text``, ``spans`` and ``answer`` as of a check; None where there are no words for it."""

def world_view_words(
    world: World, viewer: object, ids: Sequence[int], names: Sequence[str], seed: int | None
) -> dict[str, Any]:
    """``captions`` by length, and of the things of ``ids``: ``things``, ``references``, ``relations`` by the predicates of ``names``; ``room``."""

def predicates_json() -> str:
    """``predicates`` and ``orders`` with their definitions: one JSON object."""

def map(
    world: World, level: int, longest_edge: int
) -> tuple[NDArray[np.uint8], float, float, float]:
    """A storey from above (height, width, 3), with the x and z of the upper left corner and pixels a metre."""

def dollhouse(world: World, level: int, config: _Data) -> NDArray[np.uint8]:
    """A storey from outside, cut open (height, width, 3); ``config``: ``{width, yaw_deg, down_deg, cut_m}``."""

def floor_plan(world: World, level: int) -> dict[str, Any]:
    """``{floor_y, rooms: [{name, kinds, area_m2, place}], doors: [{name, hinge, shut, half, open}]}``, points (x, z)."""

def fixtures(world: World) -> dict[str, Any]:
    """``{lamps, sources, joints, boxes}`` as they stand."""

def surfaces(world: World) -> list[dict[str, Any]]:
    """For each room and material: room, ceiling, material, color (linear, with opacity), texture, positions, normals, uvs, triangles."""

def texture(house: House, texture: int) -> NDArray[np.uint8]:
    """A texture's image, sRGB with opacity (height, width, 4)."""

def bench(
    what: str,
    house: str,
    options: _Data,
    progress: Any | None = ...,
) -> dict[str, Any]: ...
