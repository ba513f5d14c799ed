"""Houses: opened once, never changed, shared by everything made from them."""

from __future__ import annotations

import copy
import json
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, overload

from dwell import ConfigError, HouseError, HouseNotFoundError, UsageError, _native, arguments
from dwell.arguments import (
    boolean,
    file_name,
    finite_number,
    integer_in_range,
    number_in_range,
    point,
    text,
)
from dwell.files import refuse_link
from dwell.grounded_text import Length, Style, Text, texts
from dwell.house_list import HouseList
from dwell.house_strings import stands_for_several
from dwell.navigation import Navigation, Walker, walker_settings

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from dwell.camera import Classes
    from dwell.editing import HouseEdit
    from dwell.engine_types import GeneratorSettings

Level = Literal["object", "room", "house", "graph", "instructions"]
Form = Literal["dwell", "suncg", "glb"]

#: Houses that a list of names holds at most.
_MAX_LISTED = 1_000_000


class House:
    """A checked, immutable house. A copy is the same house; a pickle names how to open it again."""

    def __init__(
        self,
        native: _native.House,
        again: tuple[Callable[..., House], tuple[Any, ...]] | None = None,
    ) -> None:
        """Wraps a native house; use :meth:`open` or :meth:`shoebox`.

        Args:
            native: The built half.
            again: A function and its arguments that give the house again, in another process too.

        Raises:
            ConfigError: ``native`` is something else, as a HOUSE string.
        """
        given: object = native
        if not isinstance(given, _native.House):
            raise ConfigError(
                f"House is made of a native house, not of {arguments.quoted(given)}; "
                "House.open(...) opens a house by its name"
            )
        self._native = native
        self._reopen_state = again
        self._hash: int | None = None
        #: Where somebody stands and looks best takes a while to find.
        self._rooms: list[dict[str, Any]] | None = None
        #: Kinds of things of which it was told that they stand outside of every room.
        self._told_outside: set[str] = set()

    @classmethod
    def open(
        cls, house: str | os.PathLike[str], *, map: str | os.PathLike[str] | None = None
    ) -> House:
        """Opens a HOUSE string.

        Args:
            house: ``builtin:NAME``, ``seed:N``, or the path of a SUNCG ``house.json``, a ``.dwell``
                folder, a ``.glb``, ``.gltf`` or ``.obj`` file, a ``.scene_instance.json`` of
                Habitat, a house's ``.json`` of ProcTHOR, a ``.urdf`` or MuJoCo ``.xml``, a
                ``.plan.json`` of :class:`dwell.HouseBuilder`.
            map: A file that says what foreign names of materials, nodes and rooms mean; the same as
                ``HOUSE?map=FILE``. ``docs/authoring.md`` lists its fields.

        Returns:
            The house; what its reader had to say stands in ``info()["report"]``, what it knows
            nothing of in ``info()["unmapped"]``.

        Raises:
            HouseNotFoundError: There is nothing of that name.
            HouseError: It cannot be read; the message names file, node and field.
        """
        name = arguments.path("house", house)
        if map is not None:
            name = f"{name}?map={arguments.file_path('map', map)}"
        return cls.open_by(name, None)

    @classmethod
    def open_by(cls, name: str, threads: int | None) -> House:
        """Opens a HOUSE string by so many threads; ``None``: as many as there are."""
        name = text("name", name)
        threads = None if threads is None else integer_in_range("threads", threads, low=1)
        if stands_for_several(name):
            raise HouseNotFoundError(
                f"{name!r} stands for several houses; dwell.House.expand lists them, and houses= "
                "and the commands that take several houses take it"
            )
        return cls(_native.House.open(name, threads), (House.open, (name,)))

    @staticmethod
    def expand(house: str) -> list[str]:
        """The houses that a HOUSES string stands for where several are taken.

        ``seed:3..5?home=studio`` is ``seed:3?home=studio`` and ``seed:4?home=studio``;
        ``split:val``, ``data/*.dwell`` and ``@FILE`` stand for several, too, and what stands for
        one is itself. :class:`dwell.house_list.HouseList` holds longer ranges.

        Raises:
            HouseError: A range, a split, a pattern or a list is wrong.
            ConfigError: These are more than 1,000,000 houses.
            OSError: A list cannot be read.
        """
        names = HouseList([house])
        if len(names) > _MAX_LISTED:
            raise ConfigError(f"{house}: {len(names)} houses; at most {_MAX_LISTED} are listed")
        return list(names)

    @staticmethod
    def builtins() -> list[str]:
        """The houses that come with dwell, as HOUSE strings."""
        return [f"builtin:{name}" for name in _native.builtin_names()]

    @classmethod
    def generate(cls, seed: int, **spec: Unpack[GeneratorSettings]) -> House:
        """Makes the furnished house of a seed; the same seed and spec give the same house.

        Args:
            seed: Any whole number from 0.
            **spec: What shall not be drawn from the seed: ``home`` (``"studio"``, ``"apartment"``,
                ``"house"``, ``"office"``), ``storeys`` (1 to 3), ``area_m2``, ``rooms`` (names such
                as ``"living_room"``), ``adjacency`` (pairs of them), ``style``,
                ``furniture_density`` and ``clutter`` (0 to 1), ``doors`` (``"open"``,
                ``"closed"``, ``"ajar"``, ``"mixed"``), ``time_of_day`` (0 to 24 h), ``split``
                (``"train"``, ``"val"``, ``"test"``, ``"all"``: which looks it may have).

        Returns:
            The house; what was given up stands in ``info()["report"]``.

        Raises:
            HouseError: A field cannot be had; the message names it and says what is possible.
        """
        plain = {name: arguments.to_json({name: value}) for name, value in spec.items()}
        values = {name: json.loads(value)[name] for name, value in plain.items()}
        fields = "&".join(f"{name}={json.dumps(value)}" for name, value in values.items())
        name = f"seed:{integer_in_range('seed', seed)}"
        return cls.open(f"{name}?{fields}" if fields else name)

    @classmethod
    def shoebox(
        cls,
        size_m: tuple[float, float, float],
        *,
        substance: str | None = None,
        absorption: float | None = None,
        scattering: float | None = None,
    ) -> House:
        """A closed rectangular room from the origin to ``size_m`` (x, height, z).

        Args:
            size_m: Edges, m, 0.1 to 1000 each.
            substance: What all six sides are made of, by its name in the materials table; it
                absorbs and scatters as that table says.
            absorption: Random-incidence absorption of energy, 0 to 1, at every frequency, instead
                of a substance's. Without either the floor is ``parquet``, the rest ``plaster``.
            scattering: Random-incidence scattering, 0 to 1, at every frequency; without it each
                side scatters as its substance does: also beside ``absorption``, where the floor is
                ``parquet`` and the rest ``plaster``.

        Raises:
            ConfigError: A substance and an absorption are given; a name or number that is refused.
        """
        if substance is not None and absorption is not None:
            raise ConfigError(
                f"substance, absorption: found both, {substance!r} and {absorption!r}; expected "
                "one of them, as a substance absorbs by its own table"
            )
        edges = [
            number_in_range(f"size_m[{k}]", edge, 0.1, 1000.0, "m")
            for k, edge in enumerate(point("size_m", size_m))
        ]
        again = (
            (edges[0], edges[1], edges[2]),
            None if substance is None else text("substance", substance),
            None if absorption is None else number_in_range("absorption", absorption, 0.0, 1.0),
            None if scattering is None else number_in_range("scattering", scattering, 0.0, 1.0),
        )
        return cls(_native.House.shoebox(*again), (_shoebox, again))

    def with_robot(
        self,
        path: str | os.PathLike[str],
        name: str,
        position: tuple[float, float, float],
        *,
        yaw_deg: float = 0.0,
        fixed_base: bool | None = None,
    ) -> House:
        """A new house with a robot in it; meshes are shared with this one.

        Args:
            path: A ``.urdf`` or a ``.xml`` of MuJoCo.
            name: The robot's name as an object; not taken yet.
            position: Where its base stands, m.
            yaw_deg: Where it faces, degrees, positive to the left; 0 is -Z.
            fixed_base: Whether its base is held for good; ``None``: as the file says.

        Raises:
            HouseError: The file cannot be read; the message names file, node and field.
        """
        return House(
            self._native.with_robot(
                arguments.path("path", path),
                text("name", name),
                point("position", position),
                finite_number("yaw_deg", yaw_deg),
                None if fixed_base is None else boolean("fixed_base", fixed_base),
            )
        )

    def edit(self) -> HouseEdit:
        """Begins edits: things added, moved, removed, or made of something else.

        >>> import dwell
        >>> room = dwell.House.shoebox((4.0, 2.5, 3.0), substance="plaster")
        >>> edit = room.edit().add("desk", (2.0, 0.0, 1.0), name="desk").add("mug", on="desk")
        >>> edit.done().info()["objects"]
        2
        """
        from dwell.editing import HouseEdit

        return HouseEdit(self)

    def again_after(
        self, change: Callable[..., House], *edits: str
    ) -> tuple[Callable[..., House], tuple[Any, ...]]:
        """How this house is made again after edits: from the house that was edited first.

        Houses in between are not held, so that they go when nobody else holds them.
        """
        made, arguments_ = self._reopen_state or (None, ())
        return change, (*(arguments_ if made is change else (self,)), *edits)

    def map_template(self) -> str:
        """A map file with all unmapped names, to be filled in."""
        return self._native.map_template(self.name)

    @property
    def native(self) -> _native.House:
        """The built half."""
        return self._native

    @property
    def name(self) -> str:
        """The name: the source's id or the file's name."""
        return self._native.name

    def info(self) -> dict[str, Any]:
        """Counts, rooms, categories, the report of damage, and the names that stayed unmapped."""
        return self._native.info()

    def rooms(self) -> list[dict[str, Any]]:
        """For each room: name, kinds, area_m2, floor_y, a view (eye, yaw_deg), a place to stand."""
        if self._rooms is None:
            self._rooms = self._native.rooms()
        return copy.deepcopy(self._rooms)

    def room_at(self, place: Sequence[float]) -> str | None:
        """The name of the room around a point, m; ``None`` outside of every room.

        Examples:
            >>> import dwell
            >>> house = dwell.House.open("builtin:apartment")
            >>> room = house.rooms()[0]
            >>> house.room_at(room["stand"]) == room["name"]
            True
        """
        return self._native.room_at(arguments.point("place", place))

    @overload
    def describe(
        self,
        level: Literal["object", "room", "house"] = ...,
        *,
        length: Length = ...,
        style: Style = ...,
        seed: int | None = ...,
    ) -> list[Text]: ...
    @overload
    def describe(
        self,
        level: Level,
        *,
        length: Length = ...,
        style: Style = ...,
        seed: int | None = ...,
    ) -> list[str]: ...
    def describe(
        self,
        level: Level = "house",
        *,
        length: Length = "normal",
        style: Style = "rich",
        seed: int | None = None,
    ) -> list[Text] | list[str]:
        """Sentences about the house as it starts.

        Args:
            level: ``house`` (one text), ``room`` (a text each), ``object`` (a caption each); these
                are of :class:`dwell.Text`, with spans, claims and ids. ``graph`` (one JSON object),
                ``instructions`` (a JSON object each: ``kind``, ``text``, ``form``, ``spans``, and
                ``goal`` with ``rooms``, counted from 0 as in the graph, ``objects``, the ids of
                instance images and of the graph, ``radius_m`` and ``in_sight``).
            length: Of the levels object, room and house: ``short`` (a thing's looks, the area and
                the largest things of a room, the rooms of a house), ``normal``, or ``long``, which
                also says where things stand to each other.
            style: Of the same levels: ``plain``, by nouns and places, with adjectives only where
                these tell things apart, or ``rich``, also by colours, patterns, materials and
                sizes, and rooms by the look of floor and walls.
            seed: Draws the wordings, with the name of the house; without it each sentence has its
                first wording.

        Examples:
            >>> import dwell
            >>> house = dwell.House.open("builtin:studio")
            >>> lengths = ("short", "normal", "long")
            >>> sizes = [len(house.describe("room", length=name)[0]) for name in lengths]
            >>> sizes == sorted(sizes)
            True
            >>> house.describe("object", style="plain")[0]
            'a closed door from the hallway to the outside'
        """
        seed = None if seed is None else integer_in_range("seed", seed)
        options = (text("length", length), text("style", style), seed)
        rows = self._native.describe(text("level", level), options)
        return texts(level, rows)

    def semantic_classes(self, table: Classes = "coarse") -> list[str]:
        """The names of the numbers in semantic images; 0 is void.

        Args:
            table: The ``classes`` of ``semantic``: ``coarse``, ``fine`` or ``nyu40``.
        """
        return self._native.semantic_classes(text("table", table))

    def navigation(self, walker: Walker | None = None) -> Navigation:
        """The navigation grid of the house as it starts.

        The house keeps what it found for the latest eight walkers: asked again, it answers at once.
        """
        walks = walker_settings(walker)
        return Navigation(self, walks, _native.Navigation(self._native, walks))

    def write(self, path: str | os.PathLike[str], form: Form) -> list[str]:
        """Writes the house as it starts.

        Args:
            path: What shall be there afterwards: a new folder, for ``dwell`` one whose name ends in
                ``.dwell``, or for ``glb`` a file whose name ends in ``.glb``.
            form: ``dwell`` (exact), ``suncg`` (a data root of that data set), ``glb`` (one glTF 2.0
                file with lights, node names, and meaning in ``extras.dwell``).

        Returns:
            What the form cannot hold, in sentences.

        Raises:
            HouseError: Something else stands there, as a link; nothing is written through it.
            OSError: The system refuses.
        """
        out = arguments.file_path("path", path)
        _refuse_links(Path(out))
        return self._native.write(out, text("form", form))

    def write_into(
        self, root: str | os.PathLike[str], name: str, form: Form
    ) -> tuple[Path, list[str]]:
        """Writes the house below ``root/house``, one of many that share meshes and textures.

        Args:
            root: The folder of all; :meth:`finish_folder` writes what it holds once.
            name: The house's name, one that no other house of the folder has; an old one of this
                name is replaced.
            form: As in :meth:`write`; a ``glb`` shares nothing.

        Returns:
            Where the house is, as :meth:`open` takes it, and what the form cannot hold.

        Raises:
            HouseError: Something else stands there, as a link; nothing is written through it.
            OSError: The system refuses.
        """
        root, form_name = arguments.file_path("root", root), text("form", form)
        name = file_name("name", name)
        folders = [Path(root, folder) for folder in ("house", "room", "object", "texture")]
        own = [folders[0] / f"{name}{ending}" for ending in ("", ".dwell", ".glb")]
        _refuse_links(*folders, *own, folders[1] / name)
        return self._native.write_into(root, name, form_name)

    @staticmethod
    def finish_folder(root: str | os.PathLike[str], form: Form) -> None:
        """Writes the common files of a folder of :meth:`write_into`: at the end, or again."""
        _native.House.finish_folder(arguments.file_path("root", root), text("form", form))

    def __eq__(self, other: object) -> bool:
        """Returns whether both hold the same: rooms, things, materials, meshes, images."""
        return isinstance(other, House) and (
            self._native is other._native or self._native.same(other._native)
        )

    def __hash__(self) -> int:
        """Equal for equal houses; reckoned at first use."""
        if self._hash is None:
            self._hash = self._native.fingerprint()
        return self._hash

    def __copy__(self) -> House:
        """The same: a house never changes."""
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> House:
        """The same: a house never changes."""
        return self

    def __reduce__(self) -> tuple[Callable[..., House], tuple[Any, ...]]:
        """The call that opens it again."""
        if self._reopen_state is None:
            raise UsageError(
                f"{self!r} was put together in this process and cannot be pickled; "
                "write it (house.write) and open what was written"
            )
        return self._reopen_state

    def __repr__(self) -> str:
        """The name, and the numbers of rooms and objects."""
        rooms, objects = self._native.counts
        return f"House({self.name!r}, rooms={rooms}, objects={objects})"


def split_of_seed(seed: int) -> Literal["train", "val", "test"]:
    """Which split a seed belongs to: of ten in a row, the ninth is ``val``, the tenth ``test``."""
    return {8: "val", 9: "test"}.get(integer_in_range("seed", seed) % 10, "train")  # type: ignore[return-value]


def _shoebox(
    size_m: tuple[float, float, float],
    substance: str | None,
    absorption: float | None,
    scattering: float | None,
) -> House:
    return House.shoebox(size_m, substance=substance, absorption=absorption, scattering=scattering)


def _refuse_links(*places: Path) -> None:
    """Refuses to write where one of these is a link.

    Raises:
        HouseError: One is.
    """
    try:
        for place in places:
            refuse_link(place)
    except OSError as error:
        raise HouseError(f"{error.filename}: {error.strerror}") from None
