"""Changes of a house that are noted until a new house is made of them.

What is noted is plain data: it can be saved and pickled. ``docs/authoring.md`` is the tutorial.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from types import TracebackType
from typing import TYPE_CHECKING, Any, Literal

from dwell import ConfigError, UsageError, _native, arguments
from dwell.arguments import (
    boolean,
    choice,
    finite_number,
    instance_of,
    integer_in_range,
    path,
    point,
    text,
)
from dwell.edit_fields import (
    Anchor,
    Mobility,
    Point,
    Rgb,
    Side,
    look_field,
    motion_fields,
    optional_text,
    place_field,
    rgb,
    traits_field,
)
from dwell.house import House
from dwell.sound_api import emitter_sound

if TYPE_CHECKING:
    from typing_extensions import Self


class EditList:
    """Edits, one after another: the common part of :class:`HouseEdit` and the builder.

    A thing goes where ``at`` is (x, y, z in m), which is the middle of its lower face unless
    ``anchor`` says otherwise, or ``on`` another object: there at ``at``, whose height then does not
    count, or in the middle. At ``yaw_deg`` 0 things of the catalogue face +z; positive is to the
    left. Every method gives back the same object, so that calls can be chained.
    """

    def __init__(self) -> None:
        """Begins without edits."""
        self._edits: list[dict[str, Any]] = []

    @property
    def edits(self) -> list[dict[str, Any]]:
        """The edits so far, as plain data; ``docs/authoring.md`` lists the fields."""
        edits: list[dict[str, Any]] = json.loads(arguments.to_json(self._edits))
        return edits

    def _note(self, word: str, fields: Mapping[str, Any]) -> Self:
        self._edits.append({word: {key: row for key, row in fields.items() if row is not None}})
        return self

    @staticmethod
    def kinds() -> dict[str, str]:
        """The kinds that :meth:`add` knows: those of the catalogue, each with its category.

        >>> import dwell
        >>> dwell.HouseBuilder.kinds()["mug"]
        'cup'
        """
        return _native.furniture_kinds()

    def add(
        self,
        kind: str,
        at: Point | None = None,
        *,
        on: str | None = None,
        yaw_deg: float | None = None,
        anchor: Anchor = "foot",
        name: str | None = None,
        style: str | None = None,
        seed: int = 0,
        substance: str | None = None,
        srgb: Rgb | None = None,
    ) -> Self:
        """Adds a model of the catalogue that generated houses are furnished from.

        Args:
            kind: ``"sofa"``, ``"dining_chair"``, ``"mug"``, ...: one of :meth:`kinds`; an unknown
                one is answered with the nearest.
            at: Where it goes, m. What it meets there is told by the report, and stays.
            on: The object on which it goes: without ``at`` to the free place nearest to its middle.
            yaw_deg: Where it faces.
            anchor: Which of its points ``at`` is.
            name: Its name; without one its category with a number.
            style: ``"nordic"``, ``"modern"``, ...; without one drawn by the seed.
            seed: Draws size and colours.
            substance: What all of it is made of instead.
            srgb: The colour of all of it, 0 to 255.
        """
        what = {
            "kind": text("kind", kind),
            "style": optional_text("style", style),
            "seed": integer_in_range("seed", seed),
        }
        return self._note(
            "add",
            {
                "what": {"catalogue": what},
                "name": optional_text("name", name),
                "place": place_field(at, on, yaw_deg, anchor),
                "look": look_field(substance, srgb),
            },
        )

    def add_file(
        self,
        file: str | os.PathLike[str],
        at: Point | None = None,
        *,
        on: str | None = None,
        yaw_deg: float | None = None,
        anchor: Anchor = "foot",
        name: str | None = None,
        scale: float = 1.0,
        up: Literal["y", "z"] = "y",
        category: str | None = None,
        mobility: Mobility | None = None,
        mass_kg: float | None = None,
        density_kg_m3: float | None = None,
        pickable: bool | None = None,
        substance: str | None = None,
        srgb: Rgb | None = None,
        signal: str | None = None,
        sound: str | os.PathLike[str] | None = None,
        level_db: float | None = None,
        loop: bool = True,
        start_s: float = 0.0,
    ) -> Self:
        """Adds a mesh file of your own, as one rigid thing that falls and rests.

        Args:
            file: A ``.glb``, ``.gltf`` or ``.obj``.
            at: Where it goes, m.
            on: The object on which it goes.
            yaw_deg: Where it is turned.
            anchor: Which of its points ``at`` is.
            name: Its name; without one its category with a number.
            scale: Metres for one unit of the file.
            up: Which axis of the file points up.
            category: What it is: ``"chair"``, ``"mug"``, ...
            mobility: ``"movable"`` unless told.
            mass_kg: Its mass; without it that of its category, over the box around it.
            density_kg_m3: Its mean density instead of a mass.
            pickable: Whether a hand can take it; without it by its size.
            substance: What it is made of, for hands and ears; without it what the names of the
                file's materials mean. Colours and images stay.
            srgb: Its colour, 0 to 255, instead of the file's.
            signal: What it sounds like from its middle, as for :meth:`add_emitter`,
            sound: or a sound file,
            level_db: how loud,
            loop: whether over and over,
            start_s: and from when on.
        """
        what = {"path": path("file", file), "scale": finite_number("scale", scale)}
        what["up"] = choice("up", up, ("y", "z"))
        return self._note(
            "add",
            {
                "what": {"file": what},
                "name": optional_text("name", name),
                "place": place_field(at, on, yaw_deg, anchor),
                "traits": traits_field(category, mobility, mass_kg, density_kg_m3, pickable, None),
                "look": look_field(substance, srgb, keep_look=True),
                "sound": None
                if signal is None and sound is None
                else emitter_sound(signal, sound, level_db, loop=loop, start_s=start_s),
            },
        )

    def add_box(
        self,
        size_m: Point,
        at: Point | None = None,
        *,
        on: str | None = None,
        yaw_deg: float | None = None,
        anchor: Anchor = "foot",
        name: str | None = None,
        category: str | None = None,
        mobility: Mobility | None = None,
        mass_kg: float | None = None,
        density_kg_m3: float | None = None,
        substance: str | None = None,
        srgb: Rgb | None = None,
    ) -> Self:
        """Adds a box with edges of ``size_m`` (x, height, z); the rest as for :meth:`add_file`."""
        return self._note(
            "add",
            {
                "what": {"box": {"size_m": point("size_m", size_m)}},
                "name": optional_text("name", name),
                "place": place_field(at, on, yaw_deg, anchor),
                "traits": traits_field(category, mobility, mass_kg, density_kg_m3, None, None),
                "look": look_field(substance, srgb),
            },
        )

    def add_copy(
        self,
        thing: str,
        at: Point | None = None,
        *,
        house: str | os.PathLike[str] | None = None,
        on: str | None = None,
        yaw_deg: float | None = None,
        anchor: Anchor = "foot",
        name: str | None = None,
    ) -> Self:
        """Adds a copy of an object, with its joints, lights and sounds.

        Args:
            thing: The object's name.
            at: Where the copy goes, m.
            house: The HOUSE that has the object; without it this one.
            on: The object on which it goes.
            yaw_deg: Where it faces.
            anchor: Which of its points ``at`` is.
            name: Its name; without one its category with a number.
        """
        what = {"object": text("thing", thing)}
        if house is not None:
            what["house"] = path("house", house)
        place = place_field(at, on, yaw_deg, anchor)
        return self._note(
            "add", {"what": {"copy": what}, "name": optional_text("name", name), "place": place}
        )

    def remove(self, thing: str, *, with_things: bool = False) -> Self:
        """Removes an object, ``with_things`` also what stands on it or lies in it.

        Objects behind it move up in the list; names stay.
        """
        fields = {
            "object": text("thing", thing),
            "with_things": boolean("with_things", with_things),
        }
        return self._note("remove", fields)

    def move(
        self,
        thing: str,
        at: Point | None = None,
        *,
        on: str | None = None,
        yaw_deg: float | None = None,
        by: Point | None = None,
        turn_deg: float | None = None,
        anchor: Anchor = "foot",
        with_things: bool = True,
    ) -> Self:
        """Moves an object.

        Args:
            thing: The object's name.
            at: Where it goes, m; without it it stays and may turn.
            on: The object on which it goes.
            yaw_deg: Where it faces then.
            by: By how much it is shifted after that, m.
            turn_deg: By how much it is turned after that, degrees to the left.
            anchor: Which of its points ``at`` is.
            with_things: Whether what stands on it or lies in it comes along.
        """
        return self._note(
            "move",
            {
                "object": text("thing", thing),
                **motion_fields(place_field(at, on, yaw_deg, anchor), by, turn_deg),
                "with_things": boolean("with_things", with_things),
            },
        )

    def re_material(
        self,
        *,
        room: str | None = None,
        side: Side | None = None,
        thing: str | None = None,
        part: str | None = None,
        structure: str | None = None,
        material: str | None = None,
        substance: str | None = None,
        srgb: Rgb | None = None,
        opacity: float | None = None,
        roughness: float | None = None,
        keep_look: bool = False,
    ) -> Self:
        """Changes the substance or the colour of surfaces.

        Args:
            room: A room, with ``side``: only what that room sees of its walls changes.
            side: ``"floor"``, ``"walls"`` or ``"ceiling"``.
            thing: An object,
            part: or one part of it.
            structure: A piece of the building.
            material: A material, wherever it is.
            substance: A row of the materials table; it brings its own look.
            srgb: A colour, 0 to 255, instead of colour and image.
            opacity: The fraction of light that does not pass, 0 to 1.
            roughness: As in glTF 2.0, 0 to 1.
            keep_look: The substance changes, what one sees does not.
        """
        surfaces: dict[str, Any] = {}
        if room is not None:
            wanted = choice("side", side, ("floor", "walls", "ceiling"))
            surfaces["room"] = {"name": text("room", room), "side": wanted}
        if thing is not None:
            surfaces["object"] = {"name": text("thing", thing), "part": optional_text("part", part)}
        if structure is not None:
            surfaces["structure"] = text("structure", structure)
        if material is not None:
            surfaces["material"] = text("material", material)
        if len(surfaces) != 1:
            found = ", ".join(surfaces) or "nothing"
            raise ConfigError(
                f"re_material of {found}; expected one of room, thing, structure and material"
            )
        look = {
            "substance": optional_text("substance", substance),
            "srgb": None if srgb is None else rgb("srgb", srgb),
            "opacity": None if opacity is None else finite_number("opacity", opacity),
            "roughness": None if roughness is None else finite_number("roughness", roughness),
            "keep_look": boolean("keep_look", keep_look),
        }
        return self._note("re_material", {"of": surfaces, "look": look})

    def add_emitter(
        self,
        signal: str | None = None,
        at: Point | None = None,
        *,
        sound: str | os.PathLike[str] | None = None,
        thing: str | None = None,
        level_db: float | None = None,
        loop: bool = True,
        start_s: float = 0.0,
        name: str | None = None,
    ) -> Self:
        """Adds a source of sound, which sounds in every world.

        Args:
            signal: What sounds: a name of :func:`dwell.sounds.signals`.
            at: A place, m: a small black disc that nothing touches lies right below it.
            sound: A WAV, FLAC or Ogg Vorbis file instead of a signal, of at most 64 MiB; the house
                then carries it. Channels are mixed, any rate is taken.
            thing: An object instead of a place, which sounds from its middle.
            level_db: How loud at 1 m in the free field, dB SPL (RMS over the whole sound); without
                it as usual for the signal. Files need one.
            loop: Whether it begins again when it is over.
            start_s: When it begins, s after the start of a world.
            name: The disc's name.
        """
        return self._note(
            "add_emitter",
            {
                "sound": emitter_sound(signal, sound, level_db, loop=loop, start_s=start_s),
                "object": optional_text("thing", thing),
                "at": None if at is None else point("at", at),
                "name": optional_text("name", name),
            },
        )

    def add_lamp(
        self,
        at: Point | None = None,
        *,
        kind: str | None = None,
        on: str | None = None,
        thing: str | None = None,
        yaw_deg: float | None = None,
        anchor: Anchor | None = None,
        name: str | None = None,
        style: str | None = None,
        seed: int = 0,
        power_w: float | None = None,
        srgb: Rgb | None = None,
        lit: bool = True,
    ) -> Self:
        """Adds a lamp, or light to an object.

        Args:
            at: Where the lamp goes, m.
            kind: A lamp of the catalogue: ``"ceiling_lamp"`` (default), ``"pendant"``,
                ``"floor_lamp"``, ...
            on: The object on which it goes.
            thing: An object that shines from its middle, instead of a new lamp: it has a place,
                a look and a name already.
            yaw_deg: Where it faces.
            anchor: Which of its points ``at`` is: the top of lamps that hang, the foot of others.
            name: Its name.
            style: Its style.
            seed: Draws size and colours.
            power_w: Electrical power, W, of which 1 counts as 100 lm.
            srgb: The light's colour, 0 to 255; without it warm white.
            lit: Whether it starts switched on.
        """
        seed = integer_in_range("seed", seed)
        given = {"at": at, "on": on, "yaw_deg": yaw_deg, "anchor": anchor, "name": name}
        given |= {"style": style, "kind": kind, "seed": seed or None}
        beside = [key for key, value in given.items() if value is not None]
        if thing is not None and beside:
            raise ConfigError(
                f"thing, {', '.join(beside)}: found both; expected a thing that shines from its "
                "middle, or a new lamp and where it goes"
            )
        kind = "ceiling_lamp" if kind is None else text("kind", kind)
        hangs = kind in ("ceiling_lamp", "drum_lamp", "pendant", "chandelier")
        return self._note(
            "add_lamp",
            {
                "object": optional_text("thing", thing),
                "kind": kind,
                "style": optional_text("style", style),
                "seed": seed,
                "name": optional_text("name", name),
                "place": place_field(
                    at, on, yaw_deg, ("top" if hangs else "foot") if anchor is None else anchor
                ),
                "power_w": None if power_w is None else finite_number("power_w", power_w),
                "srgb": None if srgb is None else rgb("srgb", srgb),
                "on": boolean("lit", lit),
            },
        )

    def add_robot(
        self,
        file: str | os.PathLike[str],
        name: str,
        at: Point,
        *,
        yaw_deg: float = 0.0,
        fixed_base: bool | None = None,
    ) -> Self:
        """Adds a robot, as :meth:`dwell.House.with_robot` does."""
        return self._note(
            "add_robot",
            {
                "path": path("file", file),
                "name": text("name", name),
                "at": point("at", at),
                "yaw_deg": finite_number("yaw_deg", yaw_deg),
                "fixed_base": None if fixed_base is None else boolean("fixed_base", fixed_base),
            },
        )

    def agent_start(
        self,
        at: Point | None = None,
        *,
        room: str | None = None,
        yaw_deg: float = 0.0,
        agent: int | None = None,
    ) -> Self:
        """Sets an agent's start pose, in worlds and where a task sets no other.

        Args:
            at: Where its feet are, m; without it nearest to the middle of ``room`` where someone of
                usual size can stand, as the house is after the edits before this one.
            room: The room; with ``at`` it must hold that place.
            yaw_deg: Where it faces, to the left of -z.
            agent: Which agent, counted from 0; without it the first that has no start yet.
        """
        return self._note(
            "agent_start",
            {
                "at": None if at is None else point("at", at),
                "room": optional_text("room", room),
                "yaw_deg": finite_number("yaw_deg", yaw_deg),
                "agent": None if agent is None else integer_in_range("agent", agent),
            },
        )

    def set_door(self, thing: str, opened: float, *, joint: str | None = None) -> Self:
        """Sets the initial opening of a door, drawer or lid.

        Args:
            thing: The object's name.
            opened: 0 closed, 1 fully open.
            joint: One of its joints; without it all that open.
        """
        fields = {
            "object": text("thing", thing),
            "open": finite_number("opened", opened),
            "joint": optional_text("joint", joint),
        }
        return self._note("set_door", fields)

    def describe(
        self,
        thing: str,
        *,
        category: str | None = None,
        mobility: Mobility | None = None,
        mass_kg: float | None = None,
        density_kg_m3: float | None = None,
        pickable: bool | None = None,
        switch: bool | None = None,
    ) -> Self:
        """Sets attributes of an object: category, mobility, mass, switch."""
        traits = traits_field(category, mobility, mass_kg, density_kg_m3, pickable, switch)
        return self._note("describe", {"object": text("thing", thing), "traits": traits or {}})

    def rename(
        self,
        to: str,
        *,
        thing: str | None = None,
        room: str | None = None,
        kind: str | None = None,
    ) -> Self:
        """Renames an object or a room, or without either the house.

        Args:
            to: The new name.
            thing: The object.
            room: The room,
            kind: and what people call it: ``"living room"``.
        """
        fields = {
            "object": optional_text("thing", thing),
            "room": optional_text("room", room),
            "to": text("to", to),
            "kind": optional_text("kind", kind),
        }
        return self._note("rename", fields)


class HouseEdit(EditList):
    """Changes of a house that are noted until :meth:`done` makes a new house of them.

    As a context it makes the house at the end, and :attr:`house` is it.
    """

    def __init__(self, house: House) -> None:
        """Use :meth:`dwell.House.edit`.

        Raises:
            ConfigError: ``house`` is none, as a HOUSE string.
        """
        super().__init__()
        self._base = instance_of("house", house, House)
        self._made: House | None = None

    def __repr__(self) -> str:
        """The house, and the number of edits."""
        return f"HouseEdit({self._base.name!r}, edits={len(self._edits)})"

    def done(self) -> House:
        """The edited house; it shares meshes and images with the one it was made from.

        Raises:
            HouseError: An edit cannot be; the message names it and the field, what was found, and
                what is possible. Nothing has changed then.
        """
        return _edited(self._base, arguments.to_json(self._edits))

    @property
    def house(self) -> House:
        """The house, after the end of a ``with`` block."""
        if self._made is None:
            raise UsageError("the edited house is there after the with block; or call done()")
        return self._made

    def __enter__(self) -> Self:
        """Itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Makes the house unless something went wrong."""
        if kind is None:
            self._made = self.done()


def _edited(base: House, *edits: str) -> House:
    native = base.native
    for each in edits:
        native = native.edited(each)
    return House(native, base.again_after(_edited, *edits))
