from collections.abc import Callable
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from jsonschema.protocols import Validator

from calm.errors import InputError
from calm.files import MooringFile, mooring_schema, read_mooring

CATALOGUE = """\
ball:
  kind: sphere
  diameter: 1250 mm
  mass: 300 kg
  buoyancy: 7000 N
rope-12: {kind: cable, diameter: 12 mm, weight: 0.5 N/m, breaking_load: 30 kN}
rope-16: {kind: cable, diameter: 16 mm, mass: 0.2 kg/m, density: 1380 kg/m^3}
chain-13: {kind: chain, diameter: 13 mm}
meter: {kind: cylinder, diameter: 100 mm, length: 0.5 m, mass: 10 kg, volume: 4 L, role: instrument}
plate: {kind: body, length: 0.4 m, mass: 5 kg, buoyancy: -30 N, drag_area: 0.1 m^2, cd: 1.2}
deadweight: {kind: anchor, mass: 1500 kg, length: 0.4 m}
mmp: {kind: profiler, mass: 70 kg, buoyancy: 0 N, source: a manual, searched: [length, drag_area]}
pair: {kind: assembly, parts: [{use: meter, label: upper}, {use: meter}]}
"""

GOOD = """\
name: Iroise
environment:
  depth: 1100 m
  current:
    columns: [depth m, speed m/s, toward deg]
    rows:
      - [0, 0.80, 90]
      - [200, 0.35, 80]
line:
  - {use: ball, label: top float}
  - {use: rope-12, length: 480 m, clamps: [{use: meter, at: 20 m}]}
  - {use: plate}
  - {use: deadweight}
"""

TOW = """\
name: Sonar
tow: {speed: 2 knot, toward: 90 deg, height: 4 m}
line:
  - {use: rope-12, length: 100 m, clamps: [{use: meter, at: 90 m}]}
  - {use: plate, label: fish}
"""

Place = tuple[int, int, str]


@pytest.fixture(autouse=True)
def no_catalogue_of_the_user(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CALM_CATALOG_DIR", str(tmp_path / "none"))


@pytest.fixture(scope="session")
def schema() -> Validator:
    """The schema of a mooring file, as editors use it."""
    return Draft202012Validator(mooring_schema())


@pytest.fixture
def catalogue_file(tmp_path: Path) -> Path:
    path = tmp_path / "mine.yaml"
    path.write_text(CATALOGUE)
    return path


@pytest.fixture
def read(tmp_path: Path, catalogue_file: Path) -> Callable[..., MooringFile]:
    """Reads a text as a mooring file, over a small catalogue."""

    def read_text(text: str | bytes, environment: str | Path | None = None) -> MooringFile:
        path = tmp_path / "mooring.yaml"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return read_mooring(path, environment=environment, catalogs=[catalogue_file])

    return read_text


@pytest.fixture
def mistakes(read: Callable[..., MooringFile], tmp_path: Path) -> Callable[..., list[Place]]:
    """The mistakes found in a text: line, column and message of each."""

    def find(text: str | bytes, environment: str | Path | None = None) -> list[Place]:
        with pytest.raises(InputError) as caught:
            read(text, environment)
        found = caught.value.problems
        assert all(problem.path == str(tmp_path / "mooring.yaml") for problem in found)
        return [(problem.line, problem.column, problem.message) for problem in found]

    return find
