"""Wrong arguments of other kinds: without an end, arrays for words, text for flags, odd values."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest

import dwell
import dwell.house_list
import dwell.measures
import dwell.sounds
from dwell import charts, places, plans, relations, sound_maps
from dwell.envs import DwellEnv, DwellVectorEnv
from dwell.language import say

pytestmark = pytest.mark.usefixtures("open_once")


class Blank(dwell.Sensor):
    space = gymnasium.spaces.Discrete(2)

    def observe(self, world: dwell.World, rng: np.random.Generator) -> int:
        return 0


#: A call, and how its error begins or what it holds.
CALLS = [
    # What has no end, and several values where one is expected.
    ("W.place_agent(itertools.count())", "position: expected three numbers (x, y, z) in metres"),
    ('W.relations(itertools.repeat("on"))', "has more than 1000000 elements"),
    ("W.step(itertools.repeat({}))", "has more than 1000000 elements"),
    (
        'dwell.Camera(projection="fish")',
        "camera.projection is 'fish'; expected a kind (one of pinhole, brown_conrady, fisheye,",
    ),
    ("dwell.Camera(position_m=itertools.count())", "camera.position_m: expected three numbers"),
    ("dwell.House.shoebox(itertools.count(1))", "size_m: expected three numbers (x, y, z) in"),
    ('DwellEnv(sensors=itertools.repeat("gps"))', "has more than 1000000 elements"),
    ('DwellEnv(houses=itertools.repeat("seed:1"))', "has more than 1000000 elements"),
    ('W.act("pick", pixel=itertools.count())', "pixel: expected two numbers"),
    ("SCENE.metrics_at((1, 1, 1), itertools.repeat((1, 1, 1)))", "has more than 1000000"),
    ("dwell.Receiver.array((1, 1, 1), itertools.repeat((0, 0, 0)))", "has more than 128"),
    ("dwell.Camera(preset=np.zeros(2))", "camera.preset is array([0., 0.]); allowed are flat, lit"),
    ('H.edit().add("mug", (1, 1, 1), anchor=np.zeros(2))', "anchor is array([0., 0.]); allowed"),
    (
        "H.edit().add_lamp((1, 2, 1), seed=np.zeros(2))",
        "seed is array([0., 0.]); allowed are whole",
    ),
    ("dwell.measures.response_metrics([0.0, 1.0], 8000, bands=np.zeros(2))", "bands is array("),
    # Flags, paths and numbers.
    ('DwellVectorEnv(copy="no")', "copy is 'no'; allowed are True and False"),
    ('SCENE.impulse_response((1, 1, 1), (2, 1, 2), ears="no")', "ears is 'no'; allowed are True"),
    (
        "SCENE.impulse_response((1, 1, 1), dwell.Receiver.omni((2, 1, 2)), ears=True)",
        "mic, ears: found both; a receiver has what it hears with",
    ),
    (
        "SCENE.impulse_response((1, 1, 1), dwell.Receiver.omni((2, 1, 2)), yaw_deg=30)",
        "mic, yaw_deg: found both",
    ),
    (
        "SCENE.impulse_response((1, 1, 1), (2, 1, 2), yaw_deg=90)",
        "yaw_deg is 90: a microphone at a point hears alike from all sides; expected ears=True",
    ),
    ('SCENE.impulse_response((1, 1, 1), "mic")', "mic: expected three numbers (x, y, z) in metres"),
    ('SCENE.impulse_response((1, 1, 1), "mic", ears=True)', "mic: expected three numbers"),
    ('SCENE.metrics_at((1, 1, 1), [(1, 1, 1), "mic"])', "mics[1]: expected three numbers"),
    ('dwell.sounds.read_wav("x.wav", full_scale_pa=nan)', "full_scale_pa is nan"),
    ('dwell.sounds.read_wav("x.wav", full_scale_pa=0)', "full_scale_pa is 0; allowed are numbers"),
    ('dwell.sounds.read_wav("x.wav", full_scale_pa=-1)', "full_scale_pa is -1; allowed are num"),
    ('dwell.sounds.read_wav("x.wav", full_scale_pa=None)', "full_scale_pa is None"),
    ('dwell.sounds.read_wav("x.wav", full_scale_pa="zzz")', "full_scale_pa is 'zzz'"),
    ('dwell.House.open("builtin:studio", map="")', "map is ''; expected the path of a file"),
    ('dwell.calibrate("")', "measured is ''; expected the path of a file or folder"),
    ("dwell.House.open_by(SUR, None)", "name is '\\ud800'; expected text that UTF-8 can hold"),
    ("dwell.House.open_by(None, None)", "name is None; expected text"),
    ('dwell.House.open_by("builtin:studio", -1)', "threads is -1; allowed are whole numbers from"),
    ('dwell.Directivity("polar", (1,))', "values of the form polar are (1,); expected finite"),
    ('dwell.Directivity("beam", (1,))', "form is 'beam'; allowed are first_order, sphere, polar"),
    ('HOUSES.index("builtin:studio", "x")', "start is 'x'; expected a whole number"),
    ('HOUSES.index("builtin:studio", 0, 1.5)', "stop is 1.5; expected a whole number"),
    ('HOUSES["x"]', "house is 'x'; expected a whole number"),
    # Plans of houses, and edits.
    ('B().room("k", (0, 0, 4, 4), floor=5)', "floor is 5; expected a substance, or that with a"),
    ('B().room("k", (0, 0, 4, 4), floor=("carpet",))', "floor is ('carpet',); expected a subst"),
    ('B().room("k", (0, 0, 4, 4), floor=[])', "floor is []; expected a substance"),
    ('B().room("k", (0, 0, 4, 4), floor=b"x")', "floor is b'x'; expected a substance"),
    ('B().room("k", (0, 0, 4, 4), walls=("a", 1, 2))', "walls is ('a', 1, 2), which has more than"),
    ('B().room("k", (0, 0, 4, 4), ceiling=5)', "ceiling is 5; expected a substance"),
    ('B().room("k", (0, 0, 4, 4), floor=("carpet", 5))', "floor[1] is 5; expected three whole"),
    ('B().room("k", (0, 0, 4, 4), kind=5)', "kind is 5; expected text"),
    ("B(style=5)", "style is 5; expected text"),
    ('B().door("k", name=5)', "name is 5; expected text"),
    ('B().window("k", name=5)', "name is 5; expected text"),
    ('B().door("k", side=np.zeros(2))', "side is array([0., 0.]); allowed are north, east"),
    ('B().door("k", leaf=np.zeros(2))', "leaf is array([0., 0.]); allowed are panel, glazed"),
    ('B().door("k", hinge=np.zeros(2))', "hinge is array([0., 0.]); allowed are left, right"),
    (
        'H.edit().describe("sofa_1", mobility="flying")',
        "mobility is 'flying'; allowed are fixed, movable",
    ),
    # Numbers within mappings, and rows of them.
    (
        'W.act("pick", grasp={"spring": {"frequency_hz": inf, "damping_ratio": 1}})',
        "grasp.spring.frequency_hz is inf; allowed are finite numbers",
    ),
    ('say({"claim": nan})', "form.claim is nan; allowed are finite numbers"),
    ("say({})", "form is {}; allowed are mappings as dwell.language.read gives, of one field"),
    ("dwell.measures.response_metrics(1e300, 8000)", "response: expected one row of numbers, f"),
    ("dwell.measures.response_metrics([0, 1e300], 8000)", "response[1] is 1e+300; allowed"),
    ("dwell.measures.response_metrics([0, nan], 8000)", "response[1] is nan; allowed are"),
    ("dwell.measures.response_metrics([[1], [1, 2]], 8000)", "response: expected real numbers"),
    ("dwell.measures.binaural_metrics([[0, 1e300], [0, 1]], 8000)", "ears[0][1] is 1e+300;"),
    # Things, scene graphs, and who looks.
    ('W.select("largest", None)', "things is None; expected a list of names or ids of things"),
    ('W.select("largest", "radio_1")', "things is 'radio_1'; expected a list of names or ids"),
    ('W.select("largest", itertools.repeat(1))', "has more than 1000000 elements"),
    ('W.holds("near", "agent:-1", 1)', "things is 'agent:-1'; expected a number from 0, as agen"),
    ('W.holds("near", "agent:+0", 1)', "things is 'agent:+0'; expected a number from 0, as agen"),
    ('W.holds("near", "agent:00", 1)', "things is 'agent:00'; expected a number from 0, as agen"),
    ('W.holds("on_storey", 1, "storey:+0")', "things is 'storey:+0'; expected a number from 0"),
    ('W.holds("near", None)', "to 2147483647, and names"),
    ("W.attributes(1.5)", "to 2147483647, and names"),
    ('W.relations(viewer="a")', "to 2147483647, and mappings with position, yaw_deg and pitch"),
    ("W.relations(viewer={})", "viewer is {}; expected an agent's number, or a mapping with posi"),
    ('dwell.World(H, agents="two")', "from 0 to 64, and lists of a mapping for each body"),
    ("relations.graph_arrays({})", "graph.storeys is None; expected a scene graph as World.sce"),
    ("relations.graph_arrays(None)", "graph is None; expected a scene graph as World.scene_graph"),
    ("relations.graph_arrays({**G, 'objects': [5]})", "graph.objects is [5]; expected a scene"),
    ("relations.graph_arrays({**G, 'rooms': [{}]})", "graph: no 'room'; expected a scene graph"),
    (
        "relations.graph_arrays({**G, 'relations': [{**G['relations'][0], 'predicate': 'fly'}]})",
        "graph: no 'fly'; expected a scene graph",
    ),
    (
        "relations.graph_arrays({**G, 'objects': [{**G['objects'][0], 'center': [1]}]})",
        "expected three numbers (x, y, z) in metres, found [1]",
    ),
    # Pictures.
    ("plans.sheet(None)", "pictures is None; expected a title and a picture of Pillow for each"),
    ("plans.sheet([5])", "pictures[0] is 5; expected a title and a picture of Pillow for each"),
    ('plans.sheet([("a", 5)])', "pictures[0] is ('a', 5); expected a title and a picture"),
    ("plans.sheet([], tile=5)", "tile is 5; expected pixels across and down"),
    ("plans.sheet([], tile=(5, 6, 7))", "tile is (5, 6, 7), which has more than 2 elements"),
    ("plans.houses_sheet(None)", "houses is None; expected HOUSE strings"),
    ('plans.houses_sheet("builtin:studio")', "houses is 'builtin:studio'; expected HOUSE string"),
    ('plans.room_view(W, "kitchen", CAMERA)', "room is 'kitchen'; expected a row of House.rooms("),
    ("plans.room_view(W, {}, CAMERA)", "room has no eye; expected a row of House.rooms()"),
    ("plans.room_view(None, H.rooms()[0], CAMERA)", "world is None; expected a dwell.World"),
    ("plans.room_view(W, H.rooms()[0], None)", "camera is None; expected a dwell.Camera"),
    ("sound_maps.sound_map(SCENE, (1, 1, 1), progress=5)", "progress is 5; expected a function"),
    ('sound_maps.draw_map(replace(MAP, measure="x"), W)', "found.measure is 'x'; allowed are lev"),
    ("sound_maps.draw_map(replace(MAP, measure=np.zeros(2)), W)", "found.measure is array([0., "),
    ("sound_maps.draw_map(replace(MAP, places=5), W)", "found: places of shape (1,) and values"),
    ("sound_maps.draw_map(replace(MAP, source=5), W)", "found.source is 5; expected a dwell.Sou"),
    ("sound_maps.draw_map(replace(MAP, house_hash=5), W)", "found is the map of another house"),
    ('sound_maps.draw_map(MAP, W, level="x")', "level is 'x'; allowed are whole numbers from 0"),
    # Replays whose fields were replaced.
    ('next(replace(REPLAY, actions=["fly"]).play())', "replay: actions[0] is 'fly'; allowed are"),
    ("next(replace(REPLAY, hashes=()).play())", "replay: 0 actions and 0 hashes; expected at mo"),
    ("next(replace(REPLAY, seed=-1).play())", "replay: seed is -1; allowed are whole numbers"),
    ('replace(REPLAY, seed="x").check()', "replay: seed is 'x'; allowed are whole numbers from 0"),
    (
        "replace(REPLAY, actions=None).check()",
        "replay: actions is None; expected a list of actions",
    ),
    ("replace(REPLAY, house=5).check()", "replay: house is 5; expected text"),
    ('replace(REPLAY, success="x").write(NEVER)', "replay: success is 'x'; allowed are True and F"),
    ("replace(REPLAY, hashes=()).write(NEVER)", "replay: 0 actions and 0 hashes"),
    ("replace(REPLAY, sums=5).differences()", "replay: sums is 5; expected values by name"),
    # Files without a name.
    ('dwell.Replay.read("")', "path is ''; expected the path of a file or folder"),
    ('REPLAY.write("")', "path is ''; expected the path of a file or folder"),
    ('dwell.sounds.read_wav("")', "path is ''; expected the path of a file or folder"),
    ('dwell.Head.from_sofa("")', "path is ''; expected the path of a file or folder"),
    ('H.write_into("", "a", "dwell")', "root is ''; expected the path of a file or folder"),
    ('REPLAY.write(NEVER, new="no")', "new is 'no'; allowed are True and False"),
    ('HOUSES[0:"x"]', "house is 'x'; expected a whole number"),
    (
        'DwellVectorEnv(2).reset(options={"reset_mask": [[True], [1, 2]]})',
        "reset_mask is [[True], [1, 2]]; expected bool of shape (2,)",
    ),
    ("ECHOGRAM.over_time(0)", "step_s is 0; allowed are 5e-06 to 10 s"),
    ("ECHOGRAM.decay_db(nan)", "step_s is nan; allowed are finite numbers"),
    ('ECHOGRAM.by_direction("x")', "from_s is 'x'; expected a number"),
    ("ECHOGRAM.by_direction(0.0, nan)", "to_s is nan; allowed are finite numbers"),
    # Names and mappings in place of what they stand for.
    ('dwell.House("builtin:studio")', "not of 'builtin:studio'; House.open(...) opens a house"),
    ('dwell.HouseEdit("builtin:studio")', "house is 'builtin:studio'; expected a dwell.House"),
    ('places.receiver_grid("builtin:studio", 1.0)', "house is 'builtin:studio'; expected a dwell."),
    ('places.random_sources("builtin:studio", 1)', "house is 'builtin:studio'; expected a dwell."),
    ('charts.decay_chart("x")', "echogram is 'x'; expected a dwell.Echogram"),
    ('charts.direction_chart("x")', "echogram is 'x'; expected a dwell.Echogram"),
    (
        "charts.decay_chart(ECHOGRAM, width=0)",
        "width is 0; allowed are whole numbers from 64 to 81",
    ),
    ("charts.direction_chart(ECHOGRAM, width=9000)", "width is 9000; allowed are whole numbers fr"),
    ("type(ECHOGRAM).from_json({})", "echogram: field 'paths' is missing"),
    ('type(ECHOGRAM).from_json("x")', "echogram is 'x'; expected values by name"),
    ('type(ECHOGRAM).from_json({"paths": 5, "tail": 5})', "echogram: no echogram of the engine"),
    ("W.object(None)", "name is None; expected the name of an object, or its id"),
    ("W.object(True)", "name is True; expected the name of an object, or its id"),
    ('DwellEnv("Free", sensors=[("rgb", {})])', "expected names of sensors, subclasses of dwell."),
    ('DwellEnv("Free", sensors=[("rgb", {})])', "sensors={'rgb': {'width': 64}}"),
    ('DwellEnv("Free", sensors={"": Blank})', "Blank.name is ''; expected a name for what it"),
    ('BUILDER.stairs((0, 0, 3, 3), "up")', "climb is 'up'; allowed are north, east, south, west"),
    # What a mask hides.
    ("W.place_agent(MASKED)", "position has masked elements"),
    ("dwell.Source(MASKED)", "position has masked elements"),
    ('W.set_body("radio_1", rotation=np.ma.array([0, 0, 0, 1], mask=[1, 0, 0, 0]))', "has masked"),
    # Numbers of what there is not.
    ("W.listen(agent=9)", "no agent 9; there are 1, counted from 0"),
    ('W.act("drop", agent=9)', "no agent 9; there are 1, counted from 0"),
    ("W.render(agent=9)", "no agent 9; there are 1, counted from 0"),
    ("W.place_agent((1, 0, 1), agent=9)", "no agent 9; there are 1, counted from 0"),
    ('W.play("a.mp3", at=0)', "sound is 'a.mp3'; allowed are files that end with .wav,"),
    ('W.play("phone", at=9)', "no agent 9; there are 1, counted from 0"),
    ('W.command_joint(9999, "off")', "no joint 9999; there are"),
    ("W.set_joints({9999: (0.0, 0.0)})", "no joint 9999; there are"),
]


@pytest.fixture(scope="module")
def names(apartment: dwell.House, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """The objects that the calls speak of."""
    scene = dwell.AcousticScene(apartment, rays=10)
    world = dwell.World(apartment)
    source = dwell.Source((1.0, 1.0, 1.0))
    return {
        "H": apartment,
        "W": world,
        "B": dwell.HouseBuilder,
        "G": world.scene_graph(),
        "CAMERA": dwell.Camera(16, 16),
        "MAP": sound_maps.SoundMap("level", source, np.zeros((2, 3)), np.zeros(2), 0.5),
        "NEVER": str(tmp_path_factory.mktemp("never") / "x.replay"),
        "REPLAY": dwell.Replay(
            house="builtin:studio",
            seed=1,
            config="{}",
            parts=(),
            actions=(),
            hashes=("a",),
            instruction="x",
            success=False,
            made_by="0.2.0",
        ),
        "say": say,
        "SCENE": scene,
        "ECHOGRAM": scene.echogram(source, (2.0, 1.0, 2.0)),
        "HOUSES": dwell.house_list.HouseList(["builtin:studio"]),
        "nan": math.nan,
        "inf": math.inf,
        "np": np,
        "itertools": itertools,
        "replace": replace,
        "dwell": dwell,
        "DwellEnv": DwellEnv,
        "DwellVectorEnv": DwellVectorEnv,
        "plans": plans,
        "relations": relations,
        "sound_maps": sound_maps,
        "charts": charts,
        "places": places,
        "SUR": "\ud800",
        "BUILDER": dwell.HouseBuilder(),
        "MASKED": np.ma.array([1.0, 0.0, 1.0], mask=[False, True, False]),
        "Blank": Blank,
    }


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("call", "said"), CALLS)
def test_an_odd_argument_is_named(names: dict[str, Any], call: str, said: str) -> None:
    before = names["W"].state_hash()
    with pytest.raises(dwell.DwellError) as caught:
        eval(call, names)
    assert said in str(caught.value)
    assert isinstance(caught.value, ValueError)
    assert names["W"].state_hash() == before
    assert not Path(names["NEVER"]).exists()


def test_pairs_and_corners_may_be_arrays(apartment: dwell.House) -> None:
    world, twin = dwell.World(apartment), dwell.World(apartment)
    world.set_joints({0: np.zeros(2)})
    twin.set_joints({0: (0.0, 0.0)})
    assert world.state_hash() == twin.state_hash()
    assert world.act("pick", pixel=np.array([5, 5])) == twin.act("pick", pixel=(5, 5))
    corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)]
    builders = (dwell.HouseBuilder().room("k", one) for one in (np.array(corners), corners))
    one, other = (builder.plan() for builder in builders)
    assert one == other
    robot = {"locomotion": {"differential_drive": {"wheel_base_m": 0.4}}}
    wheeled, same = (dwell.World(apartment, agents=[robot]) for _ in range(2))  # type: ignore[list-item]
    wheeled.step([{"wheel_rad_s": np.array([1.0, 2.0])}])
    same.step([{"wheel_rad_s": (1.0, 2.0)}])
    assert wheeled.state_hash() == same.state_hash()


def test_a_reset_mask_may_be_a_view() -> None:
    envs = DwellVectorEnv(3, "Free", houses="builtin:studio", sensors=["gps"])
    masks = np.array([[True, False], [False, True], [False, True]])
    ids = envs.reset(seed=1)[1]["episode_id"]
    for mask in (masks[::-1, 0], masks[:, 1]):
        now = envs.reset(options={"reset_mask": mask})[1]["episode_id"]
        assert (now != ids).tolist() == mask.tolist()
        ids = now


@pytest.mark.parametrize(
    "call",
    [
        lambda name: dwell.House.open(name),
        lambda name: dwell.World("builtin:studio", laws={name: {}}),
        lambda name: dwell.World("builtin:studio", laws={"drag": {name: 1.0}}),
        lambda name: DwellEnv("Free", houses="builtin:studio", task_settings={name: 1}),
    ],
)
def test_no_message_is_as_long_as_the_text_that_it_quotes(call: Callable[[str], object]) -> None:
    with pytest.raises(ValueError, match="xxx") as refused:
        call("x" * 100_000)
    assert len(str(refused.value)) < 10_000
