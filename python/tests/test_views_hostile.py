"""Data sets of views that others have changed: links, devices, wrong fields, cut files."""

from __future__ import annotations

import json
import os
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from dwell import cli
from dwell.house_list import HouseList
from dwell.views import ViewSettings, dataset
from dwell.views.formats import FORMS, export

SETTINGS = ViewSettings(views=2, size=64)
HOUSES = HouseList(["builtin:studio"])

pytestmark = [
    pytest.mark.usefixtures("open_once"),
    pytest.mark.skipif(sys.platform == "win32", reason="links and devices"),
]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A data set of two views."""
    out = tmp_path_factory.mktemp("views") / "set"
    assert [count for _, _, count in dataset.make(HOUSES, out, SETTINGS)] == [2]
    return out


@pytest.fixture
def folder(made: Path, tmp_path: Path) -> Path:
    """A copy of it."""
    return Path(shutil.copytree(made, tmp_path / "set"))


def house_of(folder: Path) -> Path:
    return dataset.house_folder(folder, 0)


def pictures(folder: Path, kind: str) -> list[Path]:
    return sorted(house_of(folder).glob(f"*.{kind}.png"))


def edit(folder: Path, change: Callable[[dict[str, Any]], object]) -> None:
    """Changes the first row."""
    file = house_of(folder) / "records.jsonl"
    rows = [json.loads(line) for line in file.read_text("utf-8").splitlines()]
    change(rows[0])
    file.write_text("".join(json.dumps(row) + "\n" for row in rows), "utf-8")


@pytest.mark.parametrize("form", FORMS)
def test_pictures_outside_of_the_data_set_are_not_exported(
    form: str, folder: Path, tmp_path: Path
) -> None:
    if form == "parquet":
        pytest.importorskip("pyarrow", reason="needs pyarrow (extra data)")
    secret = tmp_path / "secret"
    secret.write_text("dear diary")
    linked = pictures(folder, "rgb")[0]
    for target in (secret, Path("/dev/zero")):
        linked.unlink()
        linked.symlink_to(target)
        with pytest.raises(ValueError, match=r"\.rgb\.png: a link out of the data set"):
            export(folder, tmp_path / "out", form)
        assert not (tmp_path / "out").exists()
    linked.unlink()
    os.mkfifo(linked)
    with pytest.raises(OSError, match="is a named pipe, not a regular file"):
        export(folder, tmp_path / "out", form)


def test_a_link_within_the_data_set_and_to_it_is_followed(folder: Path, tmp_path: Path) -> None:
    first, second = pictures(folder, "rgb")
    second.unlink()
    second.symlink_to(first)
    (tmp_path / "link").symlink_to(folder)
    export(tmp_path / "link", tmp_path / "out", "coco")
    assert len({path.read_bytes() for path in (tmp_path / "out" / "train").iterdir()}) == 1


def test_records_outside_of_the_data_set_are_not_read(folder: Path, tmp_path: Path) -> None:
    house_of(folder).rename(tmp_path / "elsewhere")
    house_of(folder).symlink_to(tmp_path / "elsewhere")
    with pytest.raises(ValueError, match="a link out of the data set"):
        list(dataset.records(folder))


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda row: row["references"][0].update(text=0.5), r"references\[0\]\.text is 0\.5"),
        (lambda row: row["references"][0].update(id=10**6), r"references\[0\]\.id is 1000000"),
        (lambda row: row["captions"].pop("short"), r"captions\.short is None"),
        (lambda row: row.update(id="../../x"), "id is '../../x'"),
        (lambda row: row.update(split="../x"), "split is '../x'"),
        (lambda row: row["images"].update(rgb="../x.png"), r"images\.rgb is '../x\.png'"),
        (lambda row: row["images"].pop("depth"), "images are of"),
        (lambda row: row["things"][0].update(box=[1, 2]), r"things\[0\]\.box has 2 numbers"),
        (lambda row: row["things"][0].update(box=[0, 0, 65, 1]), r"things\[0\]\.box is .*64 x 64"),
        (lambda row: row["things"][0].update(box=[-1, 0, 2, 1]), r"things\[0\]\.box is .*64 x 64"),
        (lambda row: row["things"][0]["mask"].update(size=[9, 64]), r"mask\.size is .*\[64, 64\]"),
        (lambda row: row["things"][0]["mask"].pop("counts"), r"mask\.counts is None"),
        *(
            (
                lambda row, runs=runs: row["things"][0]["mask"].update(counts=runs),
                r"counts is .*run",
            )
            for runs in ("!!!", "", "0", "o" * 40, "P")
        ),
        (lambda row: row["things"].append(row["things"][0]), "as that of a thing before it"),
        (lambda row: row["questions"].append({}), r"questions\[\d+\]\.text is None"),
        (lambda row: row.pop("camera"), "field 'camera' is missing"),
        (lambda row: row.update(house=[]), r"house is \[\]"),
    ],
)
def test_a_field_that_is_none_is_told_with_file_and_line(
    change: Callable[[dict[str, Any]], object], told: str, folder: Path
) -> None:
    edit(folder, change)
    with pytest.raises(ValueError, match=rf"records\.jsonl line 1: .*{told}"):
        list(dataset.records(folder))


def test_two_rows_of_one_id_are_told(folder: Path) -> None:
    file = house_of(folder) / "records.jsonl"
    first = file.read_text("utf-8").splitlines()[0]
    file.write_text(f"{first}\n{first}\n", "utf-8")
    with pytest.raises(ValueError, match=r"line 2: id is '.*-000', as that of line 1"):
        list(dataset.records(folder))


def test_a_picture_that_is_none_is_told(folder: Path, tmp_path: Path) -> None:
    file = pictures(folder, "instance")[0]
    whole = file.read_bytes()
    file.write_bytes(whole[:60])
    with pytest.raises(ValueError, match=r"instance\.png: the picture was cut"):
        export(folder, tmp_path / "out", "coco")
    file.write_bytes(whole[:40] + bytes(40) + whole[80:])
    with pytest.raises(ValueError, match=r"instance\.png: no picture: "):
        export(folder, tmp_path / "out", "coco")


@pytest.mark.parametrize("form", FORMS)
def test_a_picture_that_is_none_is_not_exported(form: str, folder: Path, tmp_path: Path) -> None:
    if form == "parquet":
        pytest.importorskip("pyarrow", reason="needs pyarrow (extra data)")
    pictures(folder, "rgb")[0].write_bytes(b"hi")
    with pytest.raises(ValueError, match=r"rgb\.png: no picture in PNG"):
        export(folder, tmp_path / "out", form)


def test_what_was_cut_is_told_when_a_job_goes_on(folder: Path) -> None:
    file = pictures(folder, "depth")[1]
    whole = file.read_bytes()
    for left in (whole[:-1], whole[:40], b"", None):
        file.unlink()
        if left is not None:
            file.write_bytes(left)
        with pytest.raises(ValueError, match=r"depth\.png is missing or cut; remove .*/00000000,"):
            list(dataset.make(HOUSES, folder, SETTINGS))
    shutil.rmtree(house_of(folder))
    assert [count for _, _, count in dataset.make(HOUSES, folder, SETTINGS)] == [2]
    assert file.read_bytes() == whole


def test_a_full_disk_is_told_with_the_output(folder: Path, tmp_path: Path) -> None:
    resource = pytest.importorskip("resource")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, before[1]))
    try:
        for form in ("jsonl", "webdataset", "coco", "refcoco", "huggingface"):
            with pytest.raises(OSError, match="File too large") as refused:
                export(folder, tmp_path / "out", form)
            assert refused.value.filename == str(tmp_path / "out")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert not (tmp_path / "out").exists()


def test_a_datasheet_does_not_replace_the_data_set(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "dataset.json").write_text("{}")
    for own in (house_of(folder) / "records.jsonl", folder / "dataset.json"):
        before = own.read_bytes()
        assert cli.main(["views", "datasheet", str(folder), "--out", str(own)]) == 1
        assert "has its own files" in capsys.readouterr().err
        assert own.read_bytes() == before
    assert cli.main(["views", "datasheet", str(folder), "--out", str(folder / "README.md")]) == 0
