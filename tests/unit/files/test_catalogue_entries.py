"""Definitions as written, read when they are required."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from calm.errors import InputError
from calm.files.catalogue import UnreadLevel, read_level
from calm.shipped import shipped_folder

BALL = "# balls\n\nball:\n  kind: sphere\n  diameter: 1 m\n"
ROPE = "rope.12: # 12 mm\n  kind: cable\n  note: >\n    of\n\n    two\n"


def files(folder: Path, *texts: str) -> list[Path]:
    paths = [folder / f"{name}.yaml" for name in ("floats", "ropes")[: len(texts)]]
    for path, text in zip(paths, texts, strict=True):
        path.write_text(text)
    return paths


@pytest.mark.parametrize(
    "texts",
    [
        pytest.param((BALL + ROPE, "chain:\n  kind: chain\n"), id="plain"),
        pytest.param((BALL, "%YAML 1.2\n---\nchain:\n  kind: chain\n"), id="a document's marks"),
        pytest.param((BALL + "'quoted':\n  kind: body\n" + ROPE,), id="a quoted id"),
        pytest.param((BALL + "note: {a: '\nball:\n'}\n" + ROPE,), id="an id within a quotation"),
    ],
)
def test_the_same_as_read_whole(texts: tuple[str, ...], tmp_path: Path) -> None:
    paths = files(tmp_path, *texts)
    whole = read_level(paths, problems := [])
    assert not problems
    level = UnreadLevel(paths)
    assert {id: level[id].section.data for id in level} == {
        id: entry.section.data for id, entry in whole.items()
    }


def test_what_is_shipped() -> None:
    """Every place in it too."""
    paths = sorted(shipped_folder("catalog").glob("*.yaml"))
    whole, level = read_level(paths, []), UnreadLevel(paths)
    assert list(level) == list(whole)
    for id, entry in whole.items():
        found = level[id]
        assert (found.family, found.section.data) == (entry.family, entry.section.data)
        for location in locations(entry.section.data):
            for key in (False, True):
                expected = entry.section.problem(location, "", key=key)
                assert found.section.problem(location, "", key=key) == expected


def locations(data: object) -> Iterator[tuple[str | int, ...]]:
    """Everything in the data of a file."""
    yield ()
    pairs = data.items() if isinstance(data, dict) else enumerate(data or ())
    if not isinstance(data, str):
        for step, one in pairs:
            yield from ((step, *below) for below in locations(one))


def test_an_entry_is_read_once(tmp_path: Path) -> None:
    level = UnreadLevel(files(tmp_path, BALL, ROPE))
    assert level["ball"] is level["ball"]
    assert "rope" not in level
    assert len(level) == 2


def test_mistakes_come_all_when_one_is_met(tmp_path: Path) -> None:
    level = UnreadLevel(files(tmp_path, BALL + "bad:\n  - [\n", ROPE + "worse: \n"))
    assert level["ball"].section.data["kind"] == "sphere"
    with pytest.raises(InputError) as caught:
        level["worse"]
    assert [str(problem).removeprefix(f"{tmp_path}/") for problem in caught.value.problems] == [
        "floats.yaml:8:1: is not valid YAML: while parsing a flow node from line 8, expected the "
        "node content, but found '<stream end>'",
        "ropes.yaml:7:1: `worse` must hold `key: value` entries",
    ]


def test_an_id_given_twice(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"ropes\.yaml:3:1: `ball` is already defined, in .*:4"):
        UnreadLevel(files(tmp_path, BALL, BALL))
