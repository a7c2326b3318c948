from pathlib import Path

import pytest

from calm import shipped


def test_folders_of_this_installation() -> None:
    assert (shipped.shipped_folder("catalog") / "floats.yaml").is_file()
    assert list(shipped.shipped_folder("lines").glob("*.yaml"))


@pytest.mark.parametrize("inside", [True, False])
def test_inside_the_package_comes_before_beside_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, inside: bool
) -> None:
    package = tmp_path / "calm"
    (tmp_path / "catalog").mkdir()
    package.mkdir()
    if inside:
        (package / "_shipped" / "catalog").mkdir(parents=True)
    monkeypatch.setattr("importlib.resources.files", lambda _: package)
    expected = package / "_shipped" / "catalog" if inside else tmp_path / "catalog"
    assert shipped.shipped_folder("catalog") == expected


def test_incomplete_installation(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.resources.files", lambda _: tmp_path / "calm")
    with pytest.raises(FileNotFoundError, match="install CALM again"):
        shipped.shipped_folder("lines")
