"""The environment as levels of water: sea water by TEOS-10, gravity, viscosity and wind drift."""

from typing import Any

import gsw
import numpy as np
import pytest

import calm
from calm.assemble.arrays import DEEPEST, assemble_water
from calm.files import CurrentTable, DepthTable, Environment, Position, SeaWater, Wind

SHEARED = CurrentTable((0.0, 200.0, 900.0), (0.8, 0.3, 0.1), (0.0, 0.1, -0.2), (0.0, 0.01, 0.0))
SIXTY_NORTH = Position.model_validate({"latitude": "60 deg", "longitude": "-20 deg"})
CHANNEL = Position.model_validate({"latitude": "48.3 deg", "longitude": "-5.2 deg"})


def table(values: dict[float, float]) -> DepthTable:
    return DepthTable(tuple(values), tuple(values.values()))


def environment(**keys: Any) -> Environment:
    keys = {"fluid": "water", "depth": 1000.0, "density": 1025.0, "current": SHEARED, **keys}
    return Environment(**{"name": None, "gravity": None, "wind": None, "position": None, **keys})


def wind(text: str, **drift: Any) -> Wind:
    return Wind.model_validate({"speed": text, "toward": "30 deg", **drift})


THERMOCLINE = SeaWater(
    table({0.0: 28.0, 60.0: 27.0, 150.0: 14.0, 1000.0: 4.0}),
    table({20.0: 33.0, 300.0: 36.0, 900.0: 34.7}),
)
DEEP = SeaWater(table({0.0: 1.5}), table({0.0: 34.7}))
EXTREME = SeaWater(table({10.0: 40.0, 20.0: -6.0}), table({10.0: 0.0, 15.0: 42.0}))


@pytest.mark.parametrize(
    ("sea", "depth"),
    [(THERMOCLINE, 1000.0), (THERMOCLINE, 6000.0), (DEEP, 6000.0), (DEEP, None), (EXTREME, 90.0)],
    ids=["thermocline", "table that ends early", "deep", "tow in deep water", "extreme"],
)
def test_sea_water_is_teos_10_between_the_levels_too(sea: SeaWater, depth: float | None) -> None:
    water = assemble_water(environment(density=sea, depth=depth, position=CHANNEL))
    depths = np.linspace(0.0, water.depth, 20_001)
    temperature = np.interp(depths, sea.temperature.depth, sea.temperature.value)
    salinity = np.interp(depths, sea.salinity.depth, sea.salinity.value)
    pressure = gsw.p_from_z(-depths, 48.3)
    absolute = gsw.SA_from_SP(salinity, pressure, -5.2, 48.3)
    expected = gsw.rho(absolute, gsw.CT_from_t(absolute, temperature, pressure), pressure)
    # what `Water`, linear between its levels, is refined to
    assert water.density_at(depths) == pytest.approx(expected, rel=1e-5)
    assert len(water.level) < 60


@pytest.mark.parametrize(
    ("depth", "printed"), [(4000.0, 1046.132), (5000.0, 1050.502), (6000.0, 1054.787)]
)
def test_density_where_the_table_has_ended(depth: float, printed: float) -> None:
    """Printed for 30 degrees north, absolute salinity 34.9 g/kg, conservative temperature 1.5."""
    in_situ = float(gsw.t_from_CT(34.9, 1.5, gsw.p_from_z(-depth, 30)))
    sea = SeaWater(table({0.0: 15.0, 900.0: in_situ}), table({0.0: 34.9 * 35 / 35.16504}))
    # far inland, where sea water is taken to be of the reference composition
    inland = Position.model_validate({"latitude": "30 deg", "longitude": "80 deg"})
    water = assemble_water(environment(density=sea, depth=depth, position=inland))
    assert water.density_at(np.array(depth)) == pytest.approx(printed, abs=5.1e-4)


def test_a_constant_or_a_table_of_density_is_taken_as_it_is() -> None:
    water = assemble_water(environment())
    assert water.level.tolist() == [0, 200, 900]
    assert water.density.tolist() == [1025, 1025, 1025]
    water = assemble_water(environment(density=table({100.0: 1020.0, 200.0: 1030.0})))
    assert water.level.tolist() == [0, 100, 200, 900]
    assert water.density.tolist() == [1020, 1020, 1030, 1030]


@pytest.mark.parametrize(
    ("keys", "gravity"),
    [
        ({}, 9.80665),
        ({"position": SIXTY_NORTH}, 9.80665),
        ({"density": DEEP}, 9.80665),
        ({"density": DEEP, "position": SIXTY_NORTH}, 9.819179),
        ({"density": DEEP, "position": SIXTY_NORTH, "gravity": 9.81}, 9.81),
    ],
    ids=["nothing given", "no sea water", "no position", "both", "gravity too"],
)
def test_gravity(keys: dict[str, Any], gravity: float) -> None:
    # to the digits published of the international formula at 60 degrees
    assert assemble_water(environment(**keys)).gravity == pytest.approx(gravity, abs=5.1e-7)


def test_the_water_of_a_tow_without_depth_is_deep() -> None:
    assert assemble_water(environment(depth=None)).depth == DEEPEST


def test_viscosity_follows_temperature_and_salinity() -> None:
    sea = SeaWater(table({0.0: 20.0, 100.0: 10.0, 200.0: 0.0}), table({0.0: 35.0}))
    water = assemble_water(environment(density=sea, depth=200.0))
    got = water.viscosity_at(np.array([0.0, 100.0, 200.0]))
    # Printed at the surface, 1e-6 m²/s; at 200 m the water is 0.1 % denser.
    assert got == pytest.approx([1.0506e-6, 1.3601e-6, 1.8535e-6], rel=1.1e-3)
    # between rows 10 degrees apart it is no straight line: 1.1890 at 15 degrees, not 1.2054
    assert water.viscosity_at(np.array(50.0)) == pytest.approx(1.1890e-6, rel=1.1e-3)


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        ({}, 1.36e-6),
        ({"density": table({0.0: 1020.0, 100.0: 1030.0})}, 1.36e-6),
        ({"fluid": "air", "density": 1.225}, 1.46e-5),
    ],
    ids=["sea water", "of a density profile", "air"],
)
def test_viscosity_where_temperature_is_not_known(keys: dict[str, Any], expected: float) -> None:
    water = assemble_water(environment(**keys))
    assert (water.viscosity_at(np.array([-5.0, 0.0, 900.0])) == expected).all()


def test_wind_drives_the_surface_and_ever_less_the_water_below() -> None:
    drift = wind("10 m/s", surface_drift="2 %", drift_depth="80 m")
    density = table({0.0: 1020.0, 500.0: 1028.0})
    still = assemble_water(environment(density=density))
    driven = assemble_water(environment(density=density, wind=drift))
    assert driven.level.tolist() == [0, 80, 200, 500, 900]
    depths = np.array([0.0, 20.0, 40.0, 60.0, 80.0, 140.0, 700.0])
    added = driven.current_at(depths) - still.current_at(depths)
    # towards 30 degrees: sine to the east, cosine to the north; the differences round
    speed = 0.2 * np.array([1.0, 0.75, 0.5, 0.25, 0.0, 0.0, 0.0])
    expected = np.outer(speed, [0.5, np.sqrt(0.75), 0.0])
    assert added == pytest.approx(expected, abs=1e-15)
    assert driven.density.tolist() == still.density_at(driven.level).tolist()


def test_drift_reaches_the_seabed_where_no_depth_is_given() -> None:
    calm_water = CurrentTable((10.0,), (0.0,), (0.0,), (0.0,))
    driven = assemble_water(
        environment(current=calm_water, wind=wind("10 m/s", surface_drift=0.02))
    )
    speed = np.hypot(*driven.current_at(np.array([0.0, 500.0, 1000.0]))[:, :2].T)
    assert speed == pytest.approx([0.2, 0.1, 0.0], abs=1e-15)


@pytest.mark.parametrize("given", [wind("10 m/s"), wind("10 m/s", surface_drift=0)])
def test_wind_drives_nothing_unless_asked_to(given: Wind) -> None:
    still, blown = assemble_water(environment()), assemble_water(environment(wind=given))
    assert blown.level.tolist() == still.level.tolist()
    assert blown.u.tolist() == still.u.tolist()


MOORING = """
position: {latitude: 48.3 deg, longitude: -5.2 deg}
environment:
  depth: 3000 m
  gravity: 9.81 m/s^2
  current: {columns: [depth m, u m/s, v m/s], rows: [[0, 0.5, 0.1], [3000, 0.1, 0]]}
  density: DENSITY
line:
  - {use: ball}
  - {use: rope, length: 2800 m}
  - {use: block}
components:
  ball: {kind: sphere, diameter: 1.2 m, mass: 300 kg, volume: 0.9 m^3, source: test}
  rope: {kind: cable, diameter: 12 mm, mass: 0.12 kg/m, density: 1380 kg/m^3, stiffness: 1 MN,
    source: test}
  block: {kind: anchor, mass: 1500 kg, source: test}
"""


def test_a_mooring_does_not_mind_how_its_density_is_given(tmp_path: Any) -> None:
    """Temperature and salinity, or a table of the density they make every 50 m."""
    depth = np.arange(0.0, 3001.0, 50.0)
    pressure = gsw.p_from_z(-depth, 48.3)
    absolute = gsw.SA_from_SP(35.0, pressure, -5.2, 48.3)
    density = gsw.rho(absolute, gsw.CT_from_t(absolute, 6.0, pressure), pressure)
    rows = np.column_stack([depth, density]).tolist()
    texts = {
        "sea": "{temperature: 6 degC, salinity: 35}",
        "table": f"{{columns: [depth m, density kg/m^3], rows: {rows}}}",
        "constant": "1025 kg/m^3",
    }
    results = {}
    for name, text in texts.items():
        path = tmp_path / f"{name}.yaml"
        path.write_text(MOORING.replace("DENSITY", text))
        results[name] = calm.load(path).solve()
    sea, tabled, constant = results["sea"], results["table"], results["constant"]
    # 1e-5 of the density: 0.1 N of the float's 9 kN of displacement, 0.03 N of the rope's 2 kN
    assert sea.anchor.tension == pytest.approx(tabled.anchor.tension, abs=0.2)
    assert sea.top.depth == pytest.approx(tabled.top.depth, abs=5e-3)
    # nor is it the same as no table at all: 57 N more, of water up to 1.6 % denser
    assert sea.anchor.tension > constant.anchor.tension + 50.0
