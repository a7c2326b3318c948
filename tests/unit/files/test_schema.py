"""The JSON Schema accepts what the reader accepts, and knows the common mistakes."""

from collections.abc import Callable
from typing import Any

import jsonschema
import pytest
from jsonschema.protocols import Validator

from calm.files import MooringFile, mooring_schema
from tests.core_yaml import loaded

from . import test_strumming, test_tow
from .conftest import GOOD, TOW
from .test_bad_input import ONE_MISTAKE

EVERYTHING = """\
name: 2026
description: free text
position: {latitude: 48.3 deg, longitude: -5.2 deg}
environment:
  depth: 1100 m
  density: {columns: [depth m, density kg/m^3], rows: [[0, 1024], [500, 1028 kg/m^3]]}
  gravity: 9.81 m/s^2
  current: {speed: 0.5 m/s, toward: 0}
  wind: {speed: 12 m/s, toward: 90 deg}
line:
  - {use: ball, label: 5, hull: sphere, k_surface: 40 N/(m/s)^2, wind_cd: 1.1}
  - {use: ball, hull: {displacement: [[0, 0, 0], [1 m, 1 m^3, 1 m^2]]}}
  - use: rope-12
    length: fit
    top_depth: 105 m
    clamps: [{use: meter, at: 0, label: clamped, cn: 1.1}]
  - {use: frame, count: 2}
  - {use: measured, slack: allowed, cd: 1, serial: 12, calibrated: 2026-03-01, sampling: 9 s}
  - {use: own, length_at: {load: 2 kN, length: 20 m}, count: 2, serial: [1, 2]}
  - {use: deadweight, friction: 1/2, mass: 1.5 t}
components:
  frame: {kind: assembly, parts: [{use: own, length: 1/2 ft}, {use: chain}]}
  chain: {kind: chain, diameter: 13 mm, cn: 2.75}
  own: {kind: cable, diameter: 8 mm, mass: 0.2 kg/m, density: 0.91 g/cm^3, finish: very-rough}
  nylon: {kind: cable, diameter: 8 mm, weight: 0, breaking_load: 12 kN,
    elongation: [[0, 0], [0.1, 3 %], [50 %, 0.12]], permanent_elongation: 4 %}
  measured: {kind: body, length: 0 m, mass: 20 kg, volume: 9 L, drag_area: 0.1 m^2, cd: 1.2}
  shapes:
    kind: body
    length: 1 m
    buoyancy: 12 kgf
    made_of: [{kind: sphere, diameter: 30 cm}, {kind: cylinder, diameter: 8 cm, length: 1 m}]
environments:
  storm: {current: {columns: [depth m, u m/s, v m/s, w m/s], rows: [[0, 1, 0, 0.01]]}}
  record: {current: {file: current.csv, time: "2026-03-01T06:00"}}
solver: {angle_step: 1 deg, tolerance: 1e-7, drag: reynolds, buoy_drag: full}
checks:
  safety_factor: {steel: 3}
  minimum_tension: {wire: 50 kgf}
  maximum_tilt: 30 deg
  accept:
    - {rule: tilt, component: "?*", reason: x, by: me, date: "2026-11-22", until: "2027-11-22"}
    - {rule: strength, reason: 5}
document: {id: M-17, revision: 2, date: 2026-11-22, author: me, checked: you, approved: they,
  project: P, ship: S, cruise: C1, history: [{revision: 1, date: 2026-11-01, by: me, change: x}]}
releases: [{serial: 77, codes: 0123}, {serial: 78, codes: {enable: 1, release: "2"}}]
deployed: {date: "2026-11-22T10:30", position: {latitude: 48.3 deg, longitude: 0}, depth: 1103 m,
  items: [{label: 5, serial: 12, remark: x}, {label: rope-12, length: 99 m}]}
"""

TOWED = """\
tow: {speed: 2 knot, toward: 0, height: 4 m}
environment: {gravity: 9.81 m/s^2}
line:
  - {use: rope-12, length: fit, body_depth: 70 m, clamps: [{use: meter, at: 0}]}
  - {use: plate, lift: -9 N/(m/s)^2}
environments:
  shallow: {depth: 90 m, fluid: water}
  air: {fluid: air, density: 1.2 kg/m^3}
solver: {friction: constant, strumming: {model: bourget-marichal, a1: 1.6, strouhal: 0.17}}
"""


def test_schema_is_one() -> None:
    jsonschema.Draft202012Validator.check_schema(mooring_schema())


@pytest.mark.parametrize("text", [GOOD, EVERYTHING, TOW, TOWED, test_tow.HELICOPTER])
def test_good_files(schema: Validator, text: str) -> None:
    schema.validate(loaded(text))


@pytest.mark.parametrize("strumming", ["none", "vandiver", "{factor: 1.5}", "{cn: 1.85}"])
def test_ways_of_strumming(schema: Validator, strumming: str) -> None:
    schema.validate(loaded(GOOD + f"solver: {{strumming: {strumming}}}\n"))


def test_the_reader_takes_everything_too(read: Callable[..., MooringFile], tmp_path: Any) -> None:
    (tmp_path / "current.csv").write_text("depth[m],u[m/s],v[m/s]\n0,1,1\n")
    text = EVERYTHING.replace("{use: chain}", "{use: chain, length: 2 m}")
    assert len(read(text).pieces) == 11
    assert len(read(TOWED, "shallow").pieces) == 2


KNOWN_TO_THE_SCHEMA = [
    "missing unit",
    "unknown key",
    "unknown field on the line",
    "line of no items",
    "no line",
    "no environment",
    "uniform direction without speed",
    "decimal comma",
    "clamp without a place",
    "text for a mapping",
    "item that is text",
    "count of none",
    "drag misspelt",
    "choice misspelt",
    "limit misspelt",
]


@pytest.mark.parametrize("mistake", KNOWN_TO_THE_SCHEMA)
def test_mistakes_the_schema_knows(schema: Validator, mistake: str) -> None:
    assert not schema.is_valid(loaded(ONE_MISTAKE[mistake][0]))


KNOWN_OF_TOWS = [
    "speed missing",
    "direction missing",
    "speed without a unit",
    "key misspelt",
    "nothing",
    "a speed alone",
    "no line",
    "line empty",
    "depth misspelt",
    "environment empty",
]


@pytest.mark.parametrize("mistake", KNOWN_OF_TOWS)
def test_mistakes_of_tows_the_schema_knows(schema: Validator, mistake: str) -> None:
    assert not schema.is_valid(loaded(test_tow.ONE_MISTAKE[mistake][0]))


@pytest.mark.parametrize("strumming", test_strumming.KNOWN_TO_THE_SCHEMA)
def test_mistakes_of_strumming_the_schema_knows(schema: Validator, strumming: str) -> None:
    assert not schema.is_valid(loaded(TOW + f"solver: {{strumming: {strumming}}}\n"))


def test_only_a_mooring_needs_a_depth(schema: Validator) -> None:
    line = GOOD[GOOD.index("line:") :]
    tow = "tow: {speed: 1 m/s, toward: 0}\n"
    for environment in ("", "environment: {}\n"):
        assert not schema.is_valid(loaded(environment + line))
        assert schema.is_valid(loaded(tow + environment + line))


def test_fields_are_described() -> None:
    schema = mooring_schema()
    described = schema["$defs"]["Item"]["properties"]
    bare = {name for name, field in described.items() if "description" not in field}
    # What speaks for itself.
    assert bare <= {
        "date", "hull", "k_surface", "lift", "manufacturer", "material", "name", "part_number",
        "slack", "surface", "wind_area", "wind_cd",
    }  # fmt: skip


def keys(schema: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """The form of every key of every model, by `model.key`."""
    models = {"": schema, **schema["$defs"]}
    return {
        f"{model}.{key}": form
        for model, definition in models.items()
        for key, form in definition.get("properties", {}).items()
    }


def test_every_key_has_a_meaning_and_an_example_that_is_accepted() -> None:
    schema = mooring_schema()
    found = keys(schema)
    assert len(found) > 400
    chosen = {name: form for name, form in found.items() if "const" not in form}
    assert not [name for name, form in chosen.items() if "description" not in form]
    assert not [name for name, form in chosen.items() if "examples" not in form]
    refused = {
        name: example
        for name, form in chosen.items()
        for example in form["examples"]
        if not jsonschema.Draft202012Validator({"$defs": schema["$defs"], **form}).is_valid(example)
    }
    assert not refused
