"""Writing of a recording for the Rerun viewer."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from dwell import UsageError, _native
from dwell.camera import Camera
from dwell.false_color import light_colors, scale_colors
from dwell.house import House
from dwell.world import World

MISSING = "the Rerun SDK is not installed; pip install 'dwell[viewer]' (or rerun-sdk) gets it"
#: Textures are made smaller for the viewer, which keeps one for each mesh, pixels.
_TEXTURE_EDGE = 256
#: Paths this much weaker than the strongest are darkest, dB.
_RANGE_DB = 40.0
#: The octave band of 1 kHz among those of ``early_paths``.
_BAND_OF_1_KHZ = 4
# The viewer's classes have 16 bits.
_MAX_ID = 0xFFFF


def sdk() -> ModuleType:
    """The Rerun SDK.

    Raises:
        UsageError: It is not installed; the message says how to get it.
    """
    try:
        import rerun
    except ImportError:
        raise UsageError(MISSING) from None
    module: ModuleType = rerun
    return module


class Recording:
    """A recording in the making. Everything stands below ``world``; its frame is dwell's, +Y up."""

    def __init__(self, application: str, out: Path | None) -> None:
        """Begins a recording.

        Args:
            application: The name that the viewer shows.
            out: The ``.rrd`` file to write; ``None`` opens the viewer.

        Raises:
            UsageError: The Rerun SDK is not installed.
        """
        self._rr = sdk()
        # The viewer keeps its layouts by an id, which may not hold what stands in names of houses.
        self._stream = self._rr.RecordingStream("dwell")
        self._stream.send_recording_name(application)
        if out is None:
            self._stream.spawn()
        else:
            self._stream.save(str(out))
        self._cameras: list[str] = []
        self._texts: list[str] = []
        #: The paths of the agents that walk, by their names.
        self._walkers: dict[str, str] = {}
        self._speaks = self._hears = False
        self._corners: tuple[NDArray[Any], NDArray[Any]] | None = None
        self._log(["world"], self._rr.ViewCoordinates.RIGHT_HAND_Y_UP)

    def close(self) -> None:
        """Writes what is left, and how the viewer shows it at first."""
        self._stream.send_blueprint(self._blueprint())
        self._stream.flush()
        self._stream.disconnect()

    def house(self, world: World) -> None:
        """Surfaces by room and material, boxes with names, lamps, joints, sources of sound."""
        rr = self._rr
        house = world.house
        textures: dict[int, NDArray[np.uint8]] = {}
        for k, surface in enumerate(_native.surfaces(world.native)):
            number = surface["texture"]
            if number is not None and number not in textures:
                textures[number] = _texture(house, number)
            red, green, blue, opacity = surface["color"]
            color = light_colors(np.array([red, green, blue]))
            uvs = surface["uvs"].copy()
            uvs[:, 1] = 1.0 - uvs[:, 1]
            self._log(
                [
                    "world",
                    "ceilings" if surface["ceiling"] else "house",
                    surface["room"] or "building",
                    f"{k} {surface['material']}",
                ],
                rr.Mesh3D(
                    vertex_positions=surface["positions"],
                    vertex_normals=surface["normals"],
                    vertex_texcoords=None if number is None else uvs,
                    triangle_indices=surface["triangles"],
                    albedo_texture=None if number is None else textures[number],
                    albedo_factor=[*map(int, color), round(255 * opacity)],
                ),
            )
        fixtures = _native.fixtures(world.native)
        if fixtures["boxes"]:
            centers = np.array([row["center"] for row in fixtures["boxes"]])
            self._corners = centers.min(0), centers.max(0)
        self._boxes(fixtures["boxes"])
        self._points(fixtures["lamps"], ["world", "lamps"], _lamp)
        self._points(fixtures["sources"], ["world", "sound", "sources"], _source)
        joints = fixtures["joints"]
        if joints:
            self._log(
                ["world", "joints"],
                rr.Arrows3D(
                    origins=[joint["position"] for joint in joints],
                    vectors=[[0.25 * x for x in joint["axis"]] for joint in joints],
                    labels=[f"{joint['name']}, {joint['kind']}" for joint in joints],
                    show_labels=False,
                ),
            )
        names = [(row["id"], row["name"]) for row in fixtures["boxes"] if row["id"] <= _MAX_ID]
        self._log(["world"], rr.AnnotationContext(names))
        self.text("description", "\n".join(house.describe("house")))

    def text(self, name: str, text: str) -> None:
        """Words beside the house."""
        self._texts.append(name)
        self._log([name], self._rr.TextDocument(text))

    def view(
        self,
        world: World,
        name: str,
        eye: Sequence[float],
        yaw_deg: float,
        pitch_deg: float = -6.0,
        camera: Camera | None = None,
    ) -> None:
        """A camera's frustum with its colour, depth and ids.

        Args:
            world: The world as it stands.
            name: What the camera is called.
            eye: Where it is, m.
            yaw_deg: Where it looks, to the left of -Z.
            pitch_deg: And up.
            camera: A pinhole with ``fov_deg``; 320 by 240 and 90 degrees, if left out.
        """
        rr = self._rr
        camera = Camera(320, 240, 90.0) if camera is None else camera
        images = world.render(
            position=eye,
            yaw_deg=yaw_deg,
            pitch_deg=pitch_deg,
            camera=camera,
            channels=("rgb", "depth", "instance"),
        )
        path = ["world", "cameras", name]
        self._cameras.append(rr.new_entity_path(path))
        self._pinhole(path, camera, eye, yaw_deg, pitch_deg, static=True)
        self._log([*path, "rgb"], rr.Image(images["rgb"]))
        self._log([*path, "depth"], rr.DepthImage(images["depth"][..., 0], meter=1.0))
        ids = images["instance"][..., 0]
        ids = np.where(ids <= _MAX_ID, ids, 0).astype(np.uint16)
        self._log([*path, "ids"], rr.SegmentationImage(ids))

    def way(self, name: str, way: Sequence[Sequence[float]]) -> None:
        """Logs an agent's path: positions (x, y, z), m."""
        self._log(["world", "ways", name], self._rr.LineStrips3D([way], radii=[0.02]))

    def at_step(self, step: int) -> None:
        """What follows is of this step."""
        self._stream.set_time("step", sequence=step)

    def step(
        self,
        step: int,
        agent: Mapping[str, Any],
        image: NDArray[Any] | None,
        camera: Camera,
        *,
        name: str | None = None,
        label: str | None = None,
    ) -> None:
        """An agent at a step of its way, with what it saw.

        Args:
            step: The step's number.
            agent: A row of ``World.agents()``.
            image: Its colours, if there is a picture.
            camera: What they were taken with: a pinhole at the eyes.
            name: Its name, where there are several.
            label: What stands at its body.
        """
        rr = self._rr
        self.at_step(step)
        path = ["world", "agent"] if name is None else ["world", "agents", name]
        if image is not None:
            self._walkers["agent" if name is None else name] = rr.new_entity_path(path)
        x, y, z = agent["position"]
        body = agent["body"]
        middle = [x, y + body["height_m"] / 2, z]
        size = [2 * body["radius_m"], body["height_m"], 2 * body["radius_m"]]
        labels = None if label is None else [label]
        box = rr.Boxes3D(centers=[middle], sizes=[size], labels=labels)
        self._log([*path, "body"], box, static=False)
        eye = (x, y + body["eye_height_m"], z)
        yaw_deg, pitch_deg = map(math.degrees, (agent["yaw_rad"], agent["pitch_rad"]))
        self._pinhole([*path, "eye"], camera, eye, yaw_deg, pitch_deg, static=False)
        if image is not None:
            self._log([*path, "eye", "rgb"], rr.Image(image), static=False)

    def holds(self, name: str, thing: str | None, place: Sequence[float] | None) -> None:
        """What an agent holds from this step on, and where that is, m; ``None``: nothing."""
        rr = self._rr
        path = ["world", "agents", name, "holds"]
        if thing is None or place is None:
            self._log(path, rr.Clear(recursive=False), static=False)
            return
        self._log(path, rr.Points3D([place], radii=[0.05], labels=[thing]), static=False)

    def told(self, name: str, what: str) -> None:
        """A line about an agent at this step: what it says, understands, takes or lets go of."""
        self._speaks = True
        self._log(["agents", name], self._rr.TextLog(what), static=False)

    def ears(self, name: str, levels_db: Sequence[float]) -> None:
        """The levels at an agent's ears in this step, left and right, dB SPL."""
        self._hears = True
        for ear, level_db in zip(("left", "right"), levels_db, strict=True):
            path = ["heard", name, f"{ear} ear, dB SPL"]
            self._log(path, self._rr.Scalars(float(level_db)), static=False)

    def sound(
        self, name: str, paths: Sequence[Mapping[str, Any]], listener: Sequence[float]
    ) -> None:
        """The ways of early sound to a listener, the louder the brighter.

        Args:
            name: What sounds.
            paths: What ``AcousticScene.early_paths`` found.
            listener: Where they lead, m.
        """
        rr = self._rr
        place = ["world", "sound", "rays", name]
        self._log(
            [*place, "listener"],
            rr.Points3D([listener], radii=[0.06], labels=["listener"], show_labels=False),
        )
        if not paths:
            return
        energy = np.array([path["path"]["energy"][_BAND_OF_1_KHZ] for path in paths])
        levels_db = 10.0 * np.log10(np.maximum(energy, 1e-30))
        colors = scale_colors(1.0 + (levels_db - levels_db.max()) / _RANGE_DB)
        words = [
            f"{_reflections(path)}, {path['path']['length_m']:.2f} m, {level:.1f} dB re 1 m"
            for path, level in zip(paths, levels_db, strict=True)
        ]
        strips = [path["points"] for path in paths]
        self._log(
            place,
            rr.LineStrips3D(strips, colors=colors, labels=words, radii=[0.008], show_labels=False),
        )

    def _blueprint(self) -> object:
        """The house without ceilings from above, the cameras' images beside it."""
        from rerun import blueprint

        hidden = [f"- {camera}/{image}" for camera in self._cameras for image in ("depth", "ids")]
        contents = ["+ /world/**", "- /world/ceilings/**", *hidden]
        eye = getattr(blueprint, "EyeControls3D", None)
        look = {}
        if eye is not None and self._corners is not None:
            low, high = self._corners
            middle, size = (low + high) / 2, float(np.linalg.norm(high - low))
            place = middle + size * np.array([0.25, 0.75, 0.45])
            look["eye_controls"] = eye(position=place.tolist(), look_target=middle.tolist())
        house = blueprint.Spatial3DView(origin="/world", contents=contents, name="house", **look)
        texts: list[Any] = [
            blueprint.TextDocumentView(origin=f"/{name}", name=name) for name in self._texts
        ]
        eyes = [
            blueprint.Spatial2DView(origin=f"{path}/eye", contents=[f"+ {path}/eye/rgb"], name=name)
            for name, path in self._walkers.items()
        ]
        # Of several agents what all see stands in one place.
        seen = [blueprint.Grid(*eyes, name="agents")] if len(eyes) > 1 else eyes
        if self._speaks:
            texts.append(blueprint.TextLogView(origin="/agents", name="said and done"))
        if self._hears:
            texts.append(blueprint.TimeSeriesView(origin="/heard", name="heard"))

        def images(image: str) -> Any:  # noqa: ANN401 - a container, where the SDK has types
            views = [
                blueprint.Spatial2DView(
                    origin=camera, contents=[f"+ {camera}/{image}"], name=camera.split("/")[-1]
                )
                for camera in self._cameras
            ]
            return blueprint.Grid(*views, name=image)

        tabs = [images(image) for image in ("rgb", "depth", "ids") if self._cameras]
        beside = blueprint.Tabs(*seen, *tabs, *texts)
        return blueprint.Blueprint(blueprint.Horizontal(house, beside, column_shares=[3, 2]))

    def _log(self, path: list[str], what: object, *, static: bool = True) -> None:
        self._stream.log(path, what, static=static)

    def _boxes(self, boxes: Sequence[Mapping[str, Any]]) -> None:
        rooms: dict[str, list[Mapping[str, Any]]] = {}
        for row in boxes:
            rooms.setdefault(row["room"] or "building", []).append(row)
        for room, rows in rooms.items():
            self._log(
                ["world", "boxes", room],
                self._rr.Boxes3D(
                    centers=[row["center"] for row in rows],
                    sizes=[row["size"] for row in rows],
                    quaternions=[row["rotation"] for row in rows],
                    labels=[row["name"] for row in rows],
                    class_ids=[min(row["id"], _MAX_ID) for row in rows],
                    fill_mode=self._rr.components.FillMode.MajorWireframe,
                    show_labels=False,
                ),
            )

    def _points(
        self,
        rows: Sequence[Mapping[str, Any]],
        path: list[str],
        tell: Any,  # noqa: ANN401 - a row to its label and colour
    ) -> None:
        if not rows:
            return
        told = [tell(row) for row in rows]
        self._log(
            path,
            self._rr.Points3D(
                [row["position"] for row in rows],
                radii=[0.05],
                labels=[label for label, _ in told],
                colors=[color for _, color in told],
                show_labels=False,
            ),
        )

    def _pinhole(
        self,
        path: list[str],
        camera: Camera,
        eye: Sequence[float],
        yaw_deg: float,
        pitch_deg: float,
        *,
        static: bool,
    ) -> None:
        rr = self._rr
        half_rad = math.radians(90.0 if camera.fov_deg is None else camera.fov_deg) / 2
        focal = camera.width / 2 / math.tan(half_rad)
        turn = rr.Quaternion(xyzw=_rotation(yaw_deg, pitch_deg))
        self._log(path, rr.Transform3D(translation=list(eye), quaternion=turn), static=static)
        pinhole = rr.Pinhole(
            focal_length=focal,
            width=camera.width,
            height=camera.height,
            camera_xyz=rr.ViewCoordinates.RUB,
            image_plane_distance=0.4,
        )
        self._log(path, pinhole, static=static)


def _texture(house: House, number: int) -> NDArray[np.uint8]:
    image = Image.fromarray(_native.texture(house.native, number)[..., :3])
    image.thumbnail((_TEXTURE_EDGE, _TEXTURE_EDGE))
    return np.asarray(image)


def _lamp(row: Mapping[str, Any]) -> tuple[str, list[int]]:
    state = f"{row['power_w']:g} W" if row["on"] else "off"
    color = light_colors(np.array(row["color"])) if row["on"] else [70, 70, 70]
    return f"{row['name']}, {state}", [int(part) for part in color]


def _source(row: Mapping[str, Any]) -> tuple[str, list[int]]:
    state = f"{row['signal']}, {row['level_db']:g} dB SPL at 1 m" if row["on"] else "silent"
    return f"{row['name']}: {state}", [255, 140, 40] if row["on"] else [120, 120, 120]


def _reflections(path: Mapping[str, Any]) -> str:
    count = len(path["points"]) - 2
    return "direct" if count == 0 else f"{count} reflection{'' if count == 1 else 's'}"


def _rotation(yaw_deg: float, pitch_deg: float) -> list[float]:
    """The quaternion (x, y, z, w) of a yaw to the left and then a pitch up."""
    yaw, pitch = math.radians(yaw_deg) / 2, math.radians(pitch_deg) / 2
    sy, cy, sp, cp = math.sin(yaw), math.cos(yaw), math.sin(pitch), math.cos(pitch)
    return [cy * sp, sy * cp, -sy * sp, cy * cp]
