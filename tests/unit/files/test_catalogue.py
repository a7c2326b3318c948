"""The levels of the catalogue."""

from pathlib import Path

import pytest

from calm.errors import InputError, UsageError
from calm.files import Assembly, Catalogue, Sphere
from calm.files import catalogue as catalogues
from calm.files.catalogue import user_folder

BALL = "{kind: sphere, name: Big Ball, diameter: %s m, buoyancy: 100 N, source: here}\n"


@pytest.fixture
def shipped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A small shipped catalogue in place of the real one."""
    folder = tmp_path / "catalog"
    folder.mkdir()
    (folder / "floats.yaml").write_text(f"ball: {BALL % 1}glass-17in: {BALL % 0.43}")
    (folder / "ropes.yaml").write_text("rope-12: {kind: cable, diameter: 12 mm, weight: 1 N/m}\n")
    monkeypatch.setattr(catalogues, "shipped_folder", lambda _: folder)
    return folder


@pytest.fixture
def users(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "users"
    folder.mkdir()
    monkeypatch.setenv("CALM_CATALOG_DIR", str(folder))
    return folder


def diameter(catalogue: Catalogue, id: str) -> float:
    sphere = catalogue.get(id)
    assert isinstance(sphere, Sphere)
    return sphere.diameter


def test_the_nearer_level_wins(shipped: Path, users: Path, tmp_path: Path) -> None:
    assert diameter(Catalogue.load(), "ball") == 1.0
    (users / "mine.yaml").write_text(f"ball: {BALL % 2}own: {BALL % 9}")
    assert diameter(Catalogue.load(), "ball") == 2.0
    first, second = tmp_path / "first.yaml", tmp_path / "second.yaml"
    first.write_text(f"ball: {BALL % 3}")
    second.write_text(f"ball: {BALL % 4}")
    catalogue = Catalogue.load([first, second])
    assert diameter(catalogue, "ball") == 4.0
    assert diameter(Catalogue.load([second, first]), "ball") == 3.0
    assert diameter(catalogue, "own") == 9.0
    hidden = catalogue.hidden("ball")
    assert hidden is not None
    assert hidden.place == f"{first}:1"
    assert catalogue.hidden("own") is None


def test_ids_and_the_nearest(shipped: Path) -> None:
    catalogue = Catalogue.shipped()
    assert catalogue.ids() == ["ball", "glass-17in", "rope-12"]
    assert catalogue.nearest("glas-17") == "glass-17in"
    assert catalogue.nearest("zzz") is None
    entry = catalogue.entry("rope-12")
    assert entry is not None
    assert entry.family == "ropes"


def test_get(shipped: Path) -> None:
    assert Catalogue.shipped().get("ball").role == "float"
    with pytest.raises(UsageError, match=r"no component is called `bal`; did you mean `ball`\?"):
        Catalogue.shipped().get("bal")


def test_only_what_is_asked_for_is_validated(shipped: Path, tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.yaml"
    wrong.write_text("wrong: {kind: sphere, diameter: -1 m, cx: a, buoyancy: 1 N}\n")
    catalogue = Catalogue.load([wrong])
    assert diameter(catalogue, "ball") == 1.0
    for ask in (lambda: catalogue.get("wrong"), catalogue.all):
        with pytest.raises(InputError) as caught:
            ask()
        assert [str(problem) for problem in caught.value.problems] == [
            f"{wrong}:1:33: `diameter: -1 m` must be more than 0 m",
            f"{wrong}:1:43: `cx: a` is not a plain number",
        ]


def test_all(shipped: Path, tmp_path: Path) -> None:
    pair = tmp_path / "pair.yaml"
    pair.write_text("two: {kind: assembly, parts: [{use: ball}, {use: ball}]}\n")
    found = Catalogue.load([pair]).all()
    assert set(found) == {"ball", "glass-17in", "rope-12", "two"}
    assert isinstance(found["two"], Assembly)


def test_an_id_defined_twice(shipped: Path, users: Path) -> None:
    (users / "a.yaml").write_text(f"own: {BALL % 1}")
    (users / "b.yaml").write_text(f"\nown: {BALL % 1}")
    with pytest.raises(InputError) as caught:
        Catalogue.load()
    assert str(caught.value) == (
        f"{users}/b.yaml:2:1: `own` is already defined, in {users}/a.yaml:1"
    )


def test_mistakes_of_catalogue_files_come_at_once(users: Path, tmp_path: Path) -> None:
    (users / "a.yaml").write_text("own: 3\n")
    with pytest.raises(InputError) as caught:
        Catalogue.load([tmp_path / "none.yaml"])
    assert [str(problem) for problem in caught.value.problems] == [
        f"{tmp_path}/none.yaml: no such file",
        f"{users}/a.yaml:1:6: `own` must hold `key: value` entries",
    ]


def test_folder_of_the_user(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.delenv("CALM_CATALOG_DIR")
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    assert user_folder() == tmp_path / "calm" / "catalog"
    monkeypatch.delenv("XDG_CONFIG_HOME")
    monkeypatch.setenv("HOME", str(tmp_path))
    assert user_folder() == tmp_path / ".config" / "calm" / "catalog"
