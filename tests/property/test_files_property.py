"""Whatever a file holds, reading it gives a mooring or an InputError, and nothing else."""

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from calm.errors import InputError
from calm.files import read_mooring
from calm.units import DIMENSIONS, QuantityError, parse_quantity
from tests.core_yaml import loaded

GOOD = """\
name: Good
position: {latitude: 48.3 deg, longitude: -5.2 deg}
environment:
  depth: 1100 m
  density: {columns: [depth m, density kg/m^3], rows: [[0, 1024], [500, 1028]]}
  current:
    columns: [depth m, speed m/s, toward deg]
    rows:
      - [0, 0.80, 90]
      - [200, 0.35, 80]
line:
  - {use: ball, label: top float, count: 2}
  - {use: rope, length: 480 m, clamps: [{use: meter, at: 20 m, cd: 1.1}]}
  - {use: rope, length: fit, top_depth: 100 m}
  - {use: pair}
  - {use: dead, mass: 2 t}
components:
  ball: {kind: sphere, diameter: 1 m, buoyancy: 3 kN, hull: sphere}
  rope: {kind: cable, diameter: 12 mm, mass: 0.1 kg/m, density: 1380 kg/m^3}
  meter: {kind: body, length: 0.4 m, mass: 5 kg, volume: 3 L, drag_area: 0.1 m^2, cd: 1.2}
  shape: {kind: body, length: 1 m, buoyancy: 0, made_of: [{kind: sphere, diameter: 1 m}]}
  pair: {kind: assembly, parts: [{use: meter}, {use: shape}]}
  dead: {kind: anchor, mass: 1500 kg}
environments:
  storm: {current: {speed: 1 m/s, toward: 90 deg}, wind: {speed: 9 m/s, toward: 0}}
solver: {angle_step: 1 deg, buoy_drag: full}
checks: {safety_factor: {steel: 3}}
"""

TOW = """\
name: Towed
tow: {speed: 2 knot, toward: 90 deg, height: 40 m}
environment: {fluid: air, density: 1.2 kg/m^3}
line:
  - {use: rope, length: fit, body_depth: -20 m, clamps: [{use: ball, at: 2 m}]}
  - {use: fish, count: 2}
components:
  rope: {kind: cable, diameter: 12 mm, mass: 0.1 kg/m}
  ball: {kind: sphere, diameter: 1 m, mass: 2 kg}
  fish: {kind: body, length: 1 m, buoyancy: -9 kgf, kn: 9 N/(m/s)^2, kt: 2 N/(m/s)^2}
environments:
  sea: {fluid: water, depth: 90 m, current: {speed: 1 m/s, toward: 90 deg}}
solver: {friction: constant, strumming: {model: bourget-marichal, a1: 1.6, c0: 1.2}}
"""

FRAGMENTS = [
    "\t", "\n", " ", ":", "- ", "{", "}", "[", "]", ",", "&a ", "*a", "!x ", "|", ">", "'", '"',
    "#", "%", "@", "?", "<<", "~", "null", ".nan", ".inf", "-.inf", "1e400", "1e9", "-1", "0",
    "use", "count: ", "length: fit", "kind: ", "m/s", "kg", "°", "\u2028", "\ufeff", "\x07",
    "0x10", "true", "2026-03-01", "file: x.nc", "parts: ", "9" * 400, "é", "made_of: ", "hull: ",
    "0,5", "1/0", "tow: ", "body_depth: ", "fluid: air", "strumming: ", "factor: ",
]  # fmt: skip

VALUES = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.text(max_size=8)
    | st.sampled_from(
        ["fit", "pair", "ball", "1 m", "-1 m", "0", "35 kg", "sphere", "storm", "full"]
    ),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.text(max_size=5)
            | st.sampled_from(
                ["use", "kind", "columns", "rows", "file", "time", "parts", "displacement"]
            ),
            inner,
            max_size=3,
        )
    ),
    max_leaves=6,
)


def reads_or_refuses(folder: Path, content: bytes, environment: str | None = None) -> None:
    path = folder / "mooring.yaml"
    path.write_bytes(content)
    try:
        read_mooring(path, environment=environment)
    except InputError as error:
        assert error.problems
        for problem in error.problems:
            assert problem.message
            assert "\n" not in problem.message
            assert len(problem.message) < 400


@pytest.fixture(autouse=True)
def no_catalogue_of_the_user(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CALM_CATALOG_DIR", str(tmp_path / "none"))


def examples(count: int) -> settings:
    """So many examples, all in the same folder."""
    return settings(max_examples=count, suppress_health_check=[HealthCheck.function_scoped_fixture])


def test_the_files_are_good(tmp_path: Path) -> None:
    path = tmp_path / "mooring.yaml"
    path.write_text(GOOD)
    assert len(read_mooring(path, environment="storm").pieces) == 7
    path.write_text(TOW)
    assert len(read_mooring(path).pieces) == 3


@examples(300)
@given(
    text=st.sampled_from([GOOD, TOW]),
    edits=st.lists(
        st.tuples(st.integers(0, len(GOOD)), st.integers(0, 30), st.sampled_from(FRAGMENTS)),
        min_size=1,
        max_size=4,
    ),
)
@pytest.mark.thorough
def test_edits_of_the_text(tmp_path: Path, text: str, edits: list[tuple[int, int, str]]) -> None:
    for start, length, fragment in edits:
        text = text[:start] + fragment + text[start + length :]
    reads_or_refuses(tmp_path, text.encode())


@examples(100)
@given(start=st.integers(0, len(GOOD)), junk=st.binary(min_size=1, max_size=6))
def test_bytes_that_are_no_text(tmp_path: Path, start: int, junk: bytes) -> None:
    content = GOOD.encode()
    reads_or_refuses(tmp_path, content[:start] + junk + content[start:])


@examples(100)
@given(order=st.permutations(range(GOOD.count("\n"))))
def test_lines_in_another_order(tmp_path: Path, order: list[int]) -> None:
    lines = GOOD.splitlines(keepends=True)
    reads_or_refuses(tmp_path, "".join(lines[i] for i in order).encode())


def places(data: Any, at: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Where every value below the top is."""
    inner = data.items() if isinstance(data, dict) else enumerate(data)
    found = []
    for key, value in inner:
        found.append((*at, key))
        if isinstance(value, (dict, list)):
            found += places(value, (*at, key))
    return found


PLACES = [(text, place) for text in (GOOD, TOW) for place in places(loaded(text))]

KEYS = [
    "use", "kind", "length", "at", "file", "time", "w", "slack", "tow", "fluid", "factor", "model",
    "cn", "a1", "body_depth", "top_depth",
]  # fmt: skip


@examples(400)
@given(
    text_and_place=st.sampled_from(PLACES),
    value=VALUES,
    key=st.none() | st.sampled_from(KEYS),
    environment=st.sampled_from([None, "storm", "sea", "none", "nowhere.yaml"]),
)
@pytest.mark.thorough
def test_values_of_any_shape(
    tmp_path: Path,
    text_and_place: tuple[str, tuple[Any, ...]],
    value: Any,
    key: str | None,
    environment: str | None,
) -> None:
    text, place = text_and_place
    data = loaded(text)
    around = data
    for part in place[:-1]:
        around = around[part]
    if isinstance(around, dict) and key is not None:
        around[key] = value
    else:
        around[place[-1]] = value
    # JSON is YAML; so are its NaN and Infinity, as text.
    reads_or_refuses(tmp_path, json.dumps(data).encode(), environment)


@examples(300)
@given(text=st.text(max_size=20), dimension=st.sampled_from(sorted(DIMENSIONS)))
def test_any_text_is_a_finite_quantity_or_refused(text: str, dimension: str) -> None:
    try:
        value = parse_quantity(text, dimension)
    except QuantityError as error:
        assert error.complaint
    else:
        assert abs(value) < float("inf")


@given(
    number=st.floats(-1e12, 1e12),
    unit=st.sampled_from(
        [(name, unit) for name, kind in DIMENSIONS.items() for unit in kind.units if unit]
    ),
    space=st.sampled_from(["", " ", "  "]),
)
def test_number_and_unit_multiply(number: float, unit: tuple[str, str], space: str) -> None:
    dimension, name = unit
    factor = DIMENSIONS[dimension].units[name]
    assert parse_quantity(f"{number!r}{space}{name}", dimension) == number * factor


@given(numerator=st.integers(0, 999), denominator=st.integers(1, 64), whole=st.integers(0, 9))
def test_fractions(numerator: int, denominator: int, whole: int) -> None:
    value = parse_quantity(f"{whole} {numerator}/{denominator} in", "length")
    # Two roundings, of the fraction and of the product.
    assert value == pytest.approx((whole + numerator / denominator) * 0.0254, rel=1e-15)
