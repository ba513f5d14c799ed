"""Wrong arguments of every method: an error of dwell's own tree that says what was found."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import dwell
import dwell.evaluation
import dwell.house_list
import dwell.measures
from dwell import plans, sound_maps
from dwell.envs import DwellEnv, DwellVectorEnv
from dwell.views import ViewSettings, house_records

pytestmark = pytest.mark.usefixtures("open_once")

ROBOT = Path(__file__).parents[2] / "physics" / "tests" / "it" / "robots" / "gripper.urdf"


class Never(dwell.Task):
    max_steps = -5


#: A call, and how its error begins or what it holds.
CALLS = [
    ("W.step([1,2,3,4])", "controls has the shape (4,)"),
    ('W.step("abc")', "controls is 'abc'"),
    ("W.step(5)", "controls is 5"),
    ("W.step([[1,2,3]])", "controls has the shape (1, 3)"),
    ("W.step([[nan,0,0,0]])", "control of agent 0 (walking): forward_m_s is NaN; allowed is"),
    ('W.step([["a",0,0,0]])', "controls is [['a', 0, 0, 0]]"),
    ('W.step([{"forward_m_s": "x"}])', "controls[0].forward_m_s is 'x'"),
    ('W.step([{"nope": 1}])', "controls[0]: no field 'nope'"),
    ('W.step([{"forward_m_s": 1}, 5])', "controls[1] is 5"),
    ('W.step({"forward_m_s": 1})', "controls is {'forward_m_s': 1}"),
    ("W.step(np.zeros((1,4), complex))", "controls is array([[0.+0.j, 0.+0.j, 0.+0.j, 0.+0.j]])"),
    ("W.step(True)", "controls is True"),
    ("W.act(None)", "action is None"),
    ("W.act(5)", "action is 5"),
    ('W.act("")', 'no action ""'),
    ('W.act("fly")', 'no action "fly"'),
    ("W.act([])", "action is []"),
    ('W.act("pick", True)', "object is True"),
    ('W.act("pick", 1.5)', "object is 1.5"),
    ('W.act("pick", [1])', "object is [1]"),
    ('W.act("pick", "nothing here")', 'no object "nothing here"'),
    ('W.act("pick", 10**20)', "object is 100000000000000000000"),
    ('W.act("pick", agent="a")', "agent is 'a'"),
    ('W.act("pick", agent=True)', "agent is True"),
    ('W.act("pick", agent=9)', "no agent 9"),
    ('W.act("pick", pixel=(1,))', "pixel: expected two numbers, found (1,)"),
    ('W.act("pick", pixel=(nan,1))', "pixel[0] is nan"),
    ('W.act("pick", pixel=(1,2), camera=5)', "camera is 5"),
    (
        'W.act("throw", direction="up")',
        "direction: expected three numbers (x, y, z) in metres, found",
    ),
    ('W.act("throw", speed_m_s=1e300)', "speed_m_s is 1e+300"),
    ('W.act("throw", speed_m_s=nan)', "speed_m_s is nan"),
    ('W.act("push", force_n="hard")', "force_n is 'hard'"),
    ('W.act("push", force_n=1e300)', "force_n is 1e+300"),
    ('W.act("open", fraction=1e300)', "fraction is 1e+300"),
    ('W.act("pick", nope=1)', "no field 'nope'"),
    ('W.act({"kind": 5})', "kind is 5"),
    ("W.act({5: 5})", "a name in action is 5"),
    ("W.act({})", 'no action ""'),
    ('W.do("forward")', "no action 'forward'"),
    ("W.do(None)", "action is None"),
    ("W.do(1.0)", "action is 1.0"),
    ("W.do(-1)", "action is -1"),
    ("W.do(1, agent=7)", "no agent 7"),
    ("W.place_agent(None)", "position: expected three numbers (x, y, z) in metres, found None"),
    ("W.place_agent((1,2))", "position: expected three numbers (x, y, z) in metres, found (1, 2)"),
    ("W.place_agent((1,2,nan))", "position[2] is nan"),
    ("W.place_agent((1e300,0,0))", "position[0] is 1e+300"),
    ('W.place_agent("abc")', "position: expected three numbers (x, y, z) in metres, found 'abc'"),
    ('W.place_agent((1,0,1), yaw_deg="x")', "yaw_deg is 'x'"),
    ("W.place_agent((1,0,1), agent=5)", "no agent 5"),
    (
        "W.place_agent({1:1,2:2,3:3})",
        "position: expected three numbers (x, y, z) in metres, found {1: 1, 2:",
    ),
    ('W.render(agent="x")', "agent is 'x'"),
    ("W.render(agent=7)", "no agent 7"),
    (
        "W.render(position=(1,2))",
        "position: expected three numbers (x, y, z) in metres, found (1, 2)",
    ),
    ("W.render(yaw_deg=nan, position=(1,1,1))", "yaw_deg is nan"),
    ('W.render(yaw_deg="x", position=(1,1,1))', "yaw_deg is 'x'"),
    ("W.render(pitch_deg=[1], position=(1,1,1))", "pitch_deg is [1]"),
    ("W.render(camera=5)", "camera is 5"),
    (
        "W.render(camera=dwell.Camera(width=0))",
        "camera.width is 0; allowed are whole numbers from 1 to 16384",
    ),
    ("W.render(camera=dwell.Camera(width=-1))", "camera.width is -1"),
    ('W.render(camera=dwell.Camera(width="a"))', "camera.width is 'a'"),
    ("W.render(camera=dwell.Camera(fov_deg=nan))", "camera.fov_deg is nan"),
    (
        "W.render(camera=dwell.Camera(fov_deg=500))",
        "camera.fov_deg is 500; allowed are 1 to 175 degrees",
    ),
    ("W.render(camera=dwell.Camera(near_m=-1))", "camera.near_m is -1; allowed are 0 to 1e+06 m"),
    ("W.render(camera=dwell.Camera(far_m=0))", "camera.far_m is 0; allowed is more than near_m"),
    ('W.render(camera=dwell.Camera(preset="x"))', "camera.preset is 'x'"),
    ("W.render(camera=dwell.Camera(width=10**9))", "camera.width is 1000000000"),
    ('W.render(channels="rgb")', "channels is 'rgb'"),
    ('W.render(channels=["smell"])', 'no image "smell"'),
    ("W.render(channels=5)", "channels is 5"),
    ("W.render(channels=[5])", "channels[0] is 5"),
    ('W.map("a")', "longest_edge is 'a'"),
    ("W.map(0)", "longest_edge is 0"),
    ("W.map(10**30)", "longest_edge is 1000000000000000000000000000000"),
    ("W.map(2**31)", "longest_edge is 2147483648"),
    ("W.navigation(5)", "walker is 5"),
    ("W.navigation(dwell.Walker(radius_m=nan))", "walker.radius_m is nan"),
    ("W.navigation(dwell.Walker(radius_m=-1))", "navigation: radius_m is -1"),
    ('W.navigation(dwell.Walker(radius_m="a"))', "walker.radius_m is 'a'"),
    ('W.navigation(dwell.Walker(doors="ajar"))', "walker.doors is 'ajar'"),
    ("W.navigation(dwell.Walker(cell_m=1e300))", "walker.cell_m is 1e+300"),
    ('W.listen("a")', "samples is 'a'"),
    ("W.listen(-1)", "samples is -1"),
    ("W.listen(10**12)", "samples is 1000000000000"),
    ("W.listen(5, agent=5)", "no agent 5"),
    ('W.describe("poem")', 'level is "poem"'),
    ("W.describe(None)", "level is None"),
    ('W.holds("fly", "radio_1")', 'no predicate "fly"'),
    ("W.holds(5)", "name is 5"),
    ('W.holds("open", 1.5)', "things is 1.5"),
    ('W.holds("open", None)', "things is None"),
    ('W.holds("open", 10**12)', "things is 1000000000000"),
    ('W.holds("open", "nothing here")', 'nothing is called "nothing here"'),
    ('W.holds("open", "agent:9")', "no agent"),
    ('W.holds("open", "part:x")', '"part:x": expected part:OBJECT/PART'),
    ('W.holds("left_of", 1, 2, viewer="a")', "viewer is 'a'"),
    ('W.holds("left_of", 1, 2, viewer={"position": (nan,0,0)})', "viewer position[0] is nan"),
    ('W.why_undecided("open", "a", viewer=-1)', "viewer is -1"),
    ('W.relations("on")', "names is 'on'"),
    ('W.relations(["fly"])', 'no predicate "fly"'),
    ('W.relation_array(["left_of"])', '"left_of" needs a viewer'),
    ('W.select("largest", [1.5])', "things is 1.5"),
    ('W.select("largest", [], 0)', "n is 0"),
    ('W.attributes("nothing here")', 'no object "nothing here"'),
    ("W.attributes(None)", "thing is None"),
    ('W.color_names("nothing here", 5)', 'no object "nothing here"'),
    ("W.scene_graph(viewer=9)", "no agent 9"),
    ('W.command_joint("a", "off")', "joint is 'a'"),
    ('W.command_joint(0, "fly")', 'kind is "fly"'),
    ("W.command_joint(0, None)", "kind is None"),
    ('W.command_joint(0, "position", "x")', "value is 'x'"),
    ('W.command_joint(0, "position", nan)', "value is nan"),
    ('W.command_joint(0, "position", 1e300)', "value is 1e+300"),
    ('W.command_joint(9999, "off")', "no joint 9999"),
    ('W.command_joint(-1, "off")', "joint is -1"),
    ("W.set_joints([..., ...])", "joints is [Ellipsis, Ellipsis]"),
    ("W.set_joints([(0, 1, 1)])", "joints is [(0, 1, 1)]"),
    ("W.set_joints(None)", "joints is None"),
    ("W.set_joints({0: 1})", "joint 0: (position, velocity): expected two numbers, found 1"),
    ("W.set_joints({0: (1, nan)})", "joint 0: (position, velocity)[1] is nan"),
    ("W.set_joints({0: (1e300, 0)})", "joint 0: (position, velocity)[0] is 1e+300"),
    ('W.set_joints({"a": (0, 0)})', "joint is 'a'"),
    ("W.set_joints({9999: (0, 0)})", "no joint 9999"),
    ("W.parameter(None)", "address is None"),
    ("W.parameter(5)", "address is 5"),
    ('W.parameter("")', 'parameter address "": an address has two to five words with'),
    ('W.parameter("a/b/c")', 'parameter address "a/b/c": known are'),
    ("W.set_parameter(None, 1)", "address is None"),
    ('W.set_parameter("a/b", 1)', 'parameter address "a/b": known are'),
    ('W.set_parameter("world/gravity_m_s2", "x")', "world/gravity_m_s2 is 'x'"),
    ('W.set_parameter("world/gravity_m_s2", 1e300)', "world/gravity_m_s2 is 1e+300"),
    ('W.set_parameter("world/gravity_m_s2", True)', "world/gravity_m_s2 is True"),
    ("W.restore(None)", "snapshot is None"),
    ('W.restore(b"")', 'snapshot refused: it does not begin with "dwworld9"'),
    ('W.restore("abc")', "snapshot is 'abc'"),
    ('W.restore(b"x" * 100)', 'snapshot refused: it does not begin with "dwworld9"'),
    ("W.restore(5)", "snapshot is 5"),
    ("dwell.World(None)", "house is None"),
    ("dwell.World(5)", "house is 5"),
    ('dwell.World("builtin:nothing")', 'no built-in house "nothing"'),
    ('dwell.World(H, agents="two")', "agents is 'two'"),
    ("dwell.World(H, agents=1e6)", "agents is 1000000.0"),
    ("dwell.World(H, agents=[5])", "agents[0] is 5"),
    ('dwell.World(H, agents=[{"radius_m": nan}])', "agents[0].radius_m is nan"),
    ('dwell.World(H, agents=[{"radius_m": -1}])', "agents[0]: radius_m is -1"),
    (
        'dwell.World(H, agents=[{"nope": 1}])',
        "agents[0]: no field 'nope'; allowed are radius_m, height_m",
    ),
    ('dwell.World(H, agents=[{}, {"reach_m": "a"}])', "agents[1].reach_m is 'a'"),
    ('dwell.World(H, agents=[{"reach_m": 9}])', "agents[0]: reach_m is 9 (range 0.1 to 5 m)"),
    ('dwell.World(H, agents=[{"locomotion": 5}])', "agents[0].locomotion is 5"),
    (
        'dwell.World(H, agents=[{"locomotion": {"holonomic": {"max_forward_m_s": "a"}}}])',
        "agents[0].locomotion.holonomic.max_forward_m_s is 'a'",
    ),
    (
        'dwell.World(H, agents=[{"locomotion": {"holonomic": {"max_forward_m_s": -1}}}])',
        "agents[0], holonomic base: max_forward_m_s is -1",
    ),
    ('dwell.World(H, seed="x")', "seed is 'x'"),
    ("dwell.World(H, seed=1.5)", "seed is 1.5"),
    ("dwell.World(H, laws=5)", "laws: found 5; expected a law's name, a list of names and of {id"),
    (
        "dwell.World(H, laws=[5])",
        "laws: found [5]; expected a law's name, a list of names and of {",
    ),
    ('dwell.World(H, laws=[{"id": "nope"}])', "laws[0]: no law 'nope'; allowed are drag, "),
    ('dwell.World(H, laws=[{"id": 5}])', "laws[0].id is 5"),
    ("dwell.World(H, parameters=[1])", "parameters is [1]"),
    ("dwell.World(H, parameters=5)", "parameters is 5"),
    ("dwell.World(H, parameters={5: 1})", "a name in parameters is 5"),
    (
        'dwell.World(H, parameters={"a/b": 1})',
        'parameter address "a/b": known are',
    ),
    ('dwell.World(H, parameters={"world/gravity_m_s2": "x"})', "world/gravity_m_s2 is 'x'"),
    ('dwell.World(H, parameters={"world/gravity_m_s2": None})', "world/gravity_m_s2 is None"),
    ("dwell.World(H, nope=1)", "unknown field `nope`, expected one of `control_rate_hz`, `ph"),
    ('dwell.World(H, control_rate_hz="x")', "control_rate_hz is 'x'"),
    (
        "dwell.World(H, sound_rate_hz=-1)",
        "sound_rate_hz is -1; allowed are whole numbers from 8000 to 192000",
    ),
    ("dwell.World(H, control_rate_hz=0)", "control_rate_hz is 0"),
    ("dwell.World(H, control_rate_hz=1e300)", "control_rate_hz is 1e+300"),
    ("dwell.World(H, physics_rate_hz=[1])", "physics_rate_hz is [1]"),
    ("dwell.World(H, physics_rate_hz=0)", "physics_rate_hz is 0; allowed is a whole multiple"),
    ("dwell.House.open(None)", "house is None"),
    ("dwell.House.open(5)", "house is 5"),
    ('dwell.House.open("")', '"" is no house this version opens'),
    ('dwell.House.open("seed:abc")', "seed: found abc"),
    ('dwell.House.generate("x")', "seed is 'x'"),
    (
        'dwell.House.generate(1, home="castle")',
        "home: found unknown variant `castle`, expected one of `studi",
    ),
    ("dwell.House.generate(1, storeys=nan)", "storeys is nan"),
    (
        "dwell.House.generate(1, nope=1)",
        "nope: found unknown field `nope`, expected one of `home`, `s",
    ),
    ("dwell.House.shoebox(None)", "size_m: expected three numbers (x, y, z) in metres, found None"),
    (
        "dwell.House.shoebox((1, 2))",
        "size_m: expected three numbers (x, y, z) in metres, found (1, 2)",
    ),
    ("dwell.House.shoebox((1, 2, nan))", "size_m[2] is nan"),
    ("dwell.House.shoebox((1, 2, 1e300))", "size_m[2] is 1e+300"),
    ("dwell.House.shoebox((1, 2, -3))", "size_m[2] is -3; allowed are 0.1 to 1000 m"),
    (
        'dwell.House.shoebox("abc")',
        "size_m: expected three numbers (x, y, z) in metres, found 'abc'",
    ),
    ('dwell.House.shoebox((3, 3, 3), substance="cheese")', 'no substance "cheese"'),
    ("dwell.House.shoebox((3, 3, 3), substance=5)", "substance is 5"),
    ("dwell.House.shoebox((3, 3, 3), absorption=2)", "absorption is 2; allowed are 0 to 1"),
    ('dwell.House.shoebox((3, 3, 3), absorption="x")', "absorption is 'x'"),
    ("dwell.House.shoebox((3, 3, 3), scattering=nan)", "scattering is nan"),
    ('H.with_robot(None, "r", (1, 0, 1))', "path is None"),
    (
        'H.with_robot("/nowhere.urdf", "r", (1, 0, 1))',
        "/nowhere.urdf: No such file or directory (os error 2)",
    ),
    ("H.with_robot(arm, 5, (1, 0, 1))", "name is 5"),
    (r'H.with_robot(arm, "a\x1bb", (1, 0, 1))', "a name, without control characters"),
    (
        'H.with_robot(arm, "r", None)',
        "position: expected three numbers (x, y, z) in metres, found None",
    ),
    (
        'H.with_robot(arm, "r", (1, 0))',
        "position: expected three numbers (x, y, z) in metres, found (1, 0)",
    ),
    ('H.with_robot(arm, "r", (1, nan, 1))', "position[1] is nan"),
    ('H.with_robot(arm, "r", (1, 0, 1), yaw_deg="x")', "yaw_deg is 'x'"),
    ('H.with_robot(arm, "r", (1, 0, 1), yaw_deg=nan)', "yaw_deg is nan"),
    ('H.with_robot(arm, "r", (1, 0, 1), fixed_base="no")', "fixed_base is 'no'"),
    ('H.describe("poem")', 'level is "poem"'),
    ("H.describe(5)", "level is 5"),
    ('H.describe("instructions", seed="x")', "seed is 'x'"),
    ("H.navigation(5)", "walker is 5"),
    ("H.navigation(dwell.Walker(radius_m=inf))", "walker.radius_m is inf"),
    ('H.write(None, "dwell")', "path is None"),
    ('H.write("out", "pdf")', 'form is "pdf"'),
    ('H.write("out", None)', "form is None"),
    ('nav.points("a")', "start: expected three numbers (x, y, z) in metres, found 'a'"),
    ("nav.points((1, 2))", "start: expected three numbers (x, y, z) in metres, found (1, 2)"),
    ('nav.sample("x")', "seed is 'x'"),
    ("nav.sample(1, -1)", "count is -1"),
    ("nav.sample(1, 1, (nan, 0, 0))", "start[0] is nan"),
    ("nav.island(None)", "place: expected three numbers (x, y, z) in metres, found None"),
    ('nav.route((0, 0, 0), "a")', "goal: expected three numbers (x, y, z) in metres, found 'a'"),
    ("nav.occupancy(9)", "no storey 9"),
    ('nav.occupancy("x")', "level is 'x'"),
    ("nav.update(None)", "world is None"),
    ("nav.update(5)", "world is 5"),
    ('env.step("x")', "action is 'x'"),
    ("env.step(None)", "action is None"),
    ("env.step(99)", "action is 99"),
    ("env.step(-1)", "action is -1"),
    ("env.step(1.5)", "action is 1.5"),
    ("env.reset(options=5)", "options is 5"),
    ('DwellEnv("nope")', "task is 'nope'; allowed are Ins"),
    ("DwellEnv(5)", "task is 5"),
    ("DwellEnv(houses=3)", "houses is 3"),
    ('DwellEnv(houses="builtin:nothing")', 'no built-in house "nothing"'),
    ("DwellEnv(houses=[5])", "houses[0] is 5"),
    ("DwellEnv(sensors=5)", "sensors is 5"),
    ('DwellEnv(sensors="rgb")', "sensors is 'rgb'"),
    ('DwellEnv(sensors={"smell": {}})', 'no sensor "smell"'),
    (
        'DwellEnv(sensors={"rgb": 5})',
        "sensors.rgb: 5: found integer `5`, expected values by name",
    ),
    (
        'DwellEnv(sensors={"rgb": {"width": "x"}})',
        'sensors.rgb: width is "x": found string "x", expected a whol',
    ),
    ('DwellEnv(sensors={"rgb": {"width": nan}})', "sensors[0].settings.width is nan"),
    (
        'DwellEnv(sensors={"rgb": {"nope": 1}})',
        "sensors.rgb: nope is 1: unknown field `nope`, expected one o",
    ),
    ("DwellEnv(stride=5)", "stride is 5"),
    ('DwellEnv(stride={"nope": 1})', "stride: no field 'nope'"),
    ('DwellEnv(render_mode="x")', "render_mode: found 'x', allowed are None and ['rgb_array']"),
    ("DwellEnv(parameters=[1])", "parameters is [1]"),
    ("DwellEnv(laws=5)", "laws: found 5; expected a law's name, a list of names and of {id"),
    ("DwellEnv(world=5)", "world is 5"),
    ('DwellEnv(threads="x")', "threads is 'x'"),
    ('W.set_body("pillow_1", position=(1e9, 0, 0))', "pose is [1000000000, 0, 0], [0, 0.99"),
    ('W.set_body("pillow_1", linear_m_s=(1e9, 0, 0))', "velocity is [1000000000, 0, 0] m/s, [0,"),
    # What keeps no order, and what hides elements.
    (
        'DwellEnv(houses={"builtin:studio"})',
        "houses is {'builtin:studio'}, which keeps no order; expected HOUSE strings or Houses",
    ),
    (
        'DwellEnv(houses={"builtin:studio": 1}.keys())',
        "houses is dict_keys(['builtin:studio']), which keeps no order",
    ),
    (
        'DwellEnv(houses={"builtin:studio": 1})',
        "houses is {'builtin:studio': 1}; expected HOUSE strings or Houses",
    ),
    ('DwellEnv(sensors={"gps", "rgb"})', "which keeps no order; expected names of sensors"),
    ('DwellEnv(sensors=dict(a="gps").values())', "which keeps no order; expected names of sensors"),
    ("W.place_agent({1, 2, 3})", "found {1, 2, 3}, which keeps no order"),
    (
        'W.set_body("pillow_1", rotation={0, 1, 2, 3})',
        "rotation: expected a rotation (x, y, z, w), found {0, 1, 2, 3}, which",
    ),
    ("W.step({(0, 0, 0, 0)})", "controls is {(0, 0, 0, 0)}, which keeps no order"),
    (
        'W.render(channels={"rgb"})',
        "channels is {'rgb'}, which keeps no order; expected a list of text",
    ),
    (
        "H.edit().add_box((1, 1, 1), (1, 1, 1), srgb={1, 2, 3})",
        "srgb is {1, 2, 3}, which keeps no order",
    ),
    (
        "dwell.Receiver.array((1, 1, 1), {(0, 0, 0)})",
        "microphones is {(0, 0, 0)}, which keeps no order",
    ),
    ('dwell.calibrate("x", peers={"a"})', "peers is {'a'}, which keeps no order"),
    ('dwell.house_list.HouseList({"seed:1"})', "houses is {'seed:1'}, which keeps no order"),
    ("DwellVectorEnv(2).reset(seed={1, 2})", "seed is {1, 2}, which keeps no order"),
    (
        "W.step(np.ma.masked_array(np.zeros((1, 4)), [[1, 0, 0, 0]]))",
        "controls has masked elements",
    ),
    (
        "dwell.measures.response_metrics(np.ma.masked_array([0.0, 1.0], [1, 0]), 8000)",
        "response has masked elements",
    ),
    # Half of a pair of surrogates.
    ('W.act("pick", SUR)', "object is '\\ud800'; expected text that UTF-8 can hold"),
    ('W.act("pick", **{SUR: 1})', "a name is '\\ud800'; expected text that UTF-8 can hold"),
    ('W.play("phone", at=SUR)', "at is '\\ud800'; expected text that UTF-8 can hold"),
    ('W._native.play({"sound": {"signal": SUR}})', "expected text that UTF-8 can hold"),
    ("dwell.House.expand(SUR)", "house is '\\ud800'; expected text that UTF-8 can hold"),
    ("dwell.House.generate(1, style=SUR)", "style is '\\ud800'; expected text that UTF-8 can hold"),
    ("dwell.calibrate(SUR)", "measured is '\\ud800'; expected text that UTF-8 can hold"),
    ("dwell.AcousticScene(H, **{SUR: 1})", "expected text that UTF-8 can hold"),
    (
        'DwellEnv("Free", task_settings={"start": SUR})',
        "task_settings.start is '\\ud800'; expected text that UTF-8 can hold",
    ),
    ("env.describe(SUR)", "level is '\\ud800'; expected text that UTF-8 can hold"),
    # Names and numbers of calls that are seldom made.
    (
        'W.act("pick", True)',
        "object is True; allowed are whole numbers from -2147483648 to 2147483647, and names",
    ),
    (
        "W.place_agent((1, 0, 1), pitch_deg=86)",
        "pitch_deg is 86; allowed are -85.9 to 85.9 degrees",
    ),
    ('H.edit().add("mug", on="table_1", name=3)', "name is 3; expected text"),
    ('H.edit().add("mug", on=3)', "on is 3; expected text"),
    ('H.edit().add("mug", (1, 1, 1), style=3)', "style is 3; expected text"),
    ('H.edit().rename("a", thing=3)', "thing is 3; expected text"),
    ('H.edit().add_file("a.glb", (1, 1, 1), up="x")', "up is 'x'; allowed are y, z"),
    (
        'H.edit().add_lamp((1, 2, 1), thing="mug_1")',
        "thing, at: found both; expected a thing that shines",
    ),
    (
        'H.edit().add_lamp(thing="mug_1", kind="pendant", on="table_1")',
        "thing, on, kind: found both",
    ),
    (
        "dwell.Camera(projection={})",
        "camera.projection.kind is None; allowed are pinhole, brown_conrady,",
    ),
    (
        'dwell.Camera(projection={"kind": "eye"})',
        "camera.projection.kind is 'eye'; allowed are pinhole,",
    ),
    (
        'dwell.Camera(projection={"kind": "cubemap", "fx": 1})',
        "camera.projection: found 'fx'; cubemap has no numbers",
    ),
    (
        'dwell.Camera(projection={"kind": "pinhole", "fx": 1})',
        "camera.projection has no cx; pinhole has fx, fy, cx, cy",
    ),
    ("dwell.House.shoebox((4, 3, 5), scattering=-1)", "scattering is -1; allowed are 0 to 1"),
    (
        'dwell.House.open("builtin:studio").navigation().update(W)',
        "world is over another house, 'apartment'; this navigation is of 'studio'",
    ),
    ("dwell.calibrate(None)", "measured is None; expected text or a path"),
    ('dwell.calibrate("x", progress=5)', "progress is 5; expected a function or None"),
    (
        'dwell.evaluation.evaluate("stop", task="Free", progress=5)',
        "progress is 5; expected a function or None",
    ),
    ("W.set_gesture(0, point_at=(1, 1, 5000))", "point_at is (1.0, 1.0, 5000.0); allowed are"),
    ("house_records(5, ViewSettings(views=1))", "name is 5; expected text"),
    ("dwell.House.generate(1, area_m2=np.ma.masked)", "area_m2 has masked elements; give what"),
    ("dwell.Replay.read(None)", "path is None; expected text or a path"),
    ('dwell.Replay.read(b"x")', "path is b'x'; expected text"),
    ('REPLAY.write("x.replay")', "replay: config: no JSON: line 1 column 1"),
    ('next(REPLAY.play(house="builtin:studio"))', "replay: config: no JSON"),
    ("dwell.Receiver({}, {})", "pose has nothing; expected position and rotation"),
    (
        'dwell.Source((1, 1, 1), directivity="no").to_json()',
        "directivity: no 'no'; there are omni,",
    ),
    ("plans.floor_plan(None)", "world is None; expected a dwell.World"),
    ("plans.levels_of(W)", "expected a dwell.House"),
    (
        'plans.floor_plan(W, ways=[("notacolour", [(1, 0, 1)])])',
        "ways[0][0] is 'notacolour'; expected a colour",
    ),
    (
        'plans.floor_plan(W, ways=[("red", [(nan, 0, 1)])])',
        "ways[0][1][0][0] is nan; allowed are finite",
    ),
    (
        "plans.floor_plan(W, squares=[(1, 1, -1, (1, 2, 3))])",
        "squares[0][2] is -1; allowed are edges above 0 m",
    ),
    (
        "plans.floor_plan(W, squares=[(1, 1, 1, (300, 2, 3))])",
        "squares[0][3][0] is 300; allowed are whole numbers",
    ),
    ("sound_maps.sound_map(None, (1, 1, 1))", "scene is None; expected a dwell.AcousticScene"),
    (
        'dwell.register_task("me/Never-v0", Never)',
        "Never.max_steps is -5; allowed are whole numbers from 1",
    ),
]


@pytest.fixture(scope="module")
def names() -> dict[str, Any]:
    """The objects that the calls speak of."""
    house = dwell.House.open("builtin:apartment")
    world = dwell.World(house)
    env = DwellEnv()
    env.reset(seed=0)
    return {
        "H": house,
        "W": world,
        "nav": world.navigation(),
        "env": env,
        "arm": str(ROBOT),
        "nan": math.nan,
        "inf": math.inf,
        "np": np,
        "dwell": dwell,
        "DwellEnv": DwellEnv,
        "ViewSettings": ViewSettings,
        "house_records": house_records,
        "DwellVectorEnv": DwellVectorEnv,
        "plans": plans,
        "sound_maps": sound_maps,
        "SUR": "\ud800",
        "Never": Never,
        "REPLAY": dwell.Replay(
            house="builtin:studio",
            seed=1,
            config="nonsense",
            parts=(),
            actions=(),
            hashes=("a",),
            instruction="x",
            success=False,
            made_by="0.2.0",
        ),
    }


@pytest.mark.parametrize(("call", "said"), CALLS)
def test_a_wrong_argument_is_named(names: dict[str, Any], call: str, said: str) -> None:
    before = names["W"].state_hash()
    with pytest.raises(dwell.DwellError) as caught:
        eval(call, names)
    assert said in str(caught.value)
    assert names["W"].state_hash() == before


def test_answers_have_the_digits_and_the_order_that_the_engine_writes() -> None:
    world = dwell.World("builtin:apartment")
    body = world.agents()[0]["body"]
    # 32 bits have no 0.2; nearest in 64 bits is 0.20000000298023224.
    assert (repr(body["radius_m"]), repr(body["step_height_m"])) == ("0.2", "0.2")
    assert [*body][:3] == ["radius_m", "height_m", "eye_height_m"]
    assert type(world.agents()[0]["grounded"]) is bool
    assert world.object("radio_1")["id"] == int(world.object("radio_1")["id"])
    address, parameter = next(iter(world.parameters().items()))
    assert world.parameter(address) == parameter
    assert [*parameter] == ["value", "unit", "low", "high"]
    rooms = world.house.rooms()
    rooms[0]["name"] = "changed"
    assert world.house.rooms()[0]["name"] != "changed"
