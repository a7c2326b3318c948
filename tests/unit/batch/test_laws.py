"""Every law of the manual in a batch, against `calm run`; and what must not be a number."""

from pathlib import Path

import numpy as np
import pytest

from calm.batch.profiles import Batch, solve_profiles
from tests.unit.batch.alike import assert_as_run
from tests.unit.batch.drawn_profiles import CHARACTERS, drawn
from tests.unit.batch.made import made_mooring

MOORING = """\
name: Test
environment:
  depth: 100 m
  density: {columns: [depth m, density kg/m^3], rows: [[0, 1022], [100, 1027]]}
  current: {speed: 0.5 m/s, toward: 90 deg}
components:
  ball: {kind: sphere, role: float, diameter: 1 m, buoyancy: 3000 N, surface: smooth}
  rope:
    kind: cable
    diameter: 12 mm
    weight: 0.5 N/m
    breaking_load: 30 kN
    STRETCH
  logger: {kind: cylinder, diameter: 60 mm, length: 0.4 m, buoyancy: -40 N, surface: smooth}
  tube: {kind: cylinder, diameter: 0.2 m, length: 1.2 m, buoyancy: -300 N, surface: smooth}
  weight: {kind: anchor, weight: 9000 N, length: 0.4 m}
line:
  - {use: ball}
  - {use: rope, length: 30 m, clamps: [{use: logger, at: 10 m}]}
  - {use: tube}
  - {use: rope, length: LENGTH m}
  - {use: weight}
solver: {SOLVER}
"""
STIFF = "stiffness: 40 kN"
TABLE = "elongation: [[0.05, 0.05], [0.1, 0.08], [0.2, 0.12]]\n    permanent_elongation: 4 %"
LAWS = {
    "friction along the current": ("friction: hoerner", STIFF),
    "friction whatever the angle": ("friction: constant", STIFF),
    "an elongation table": ("friction: berteaux", TABLE),
    "drag curves": ("drag: reynolds", STIFF),
    "strumming by an amplitude": ("strumming: vandiver", STIFF),
    "all at once": ("friction: hoerner, drag: reynolds, strumming: skop-griffin", TABLE),
}


@pytest.mark.parametrize("length", [45.0, 90.0], ids=["below", "at the surface"])
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())
def test_every_law_is_solved_as_by_the_run(
    tmp_path: Path, law: tuple[str, str], length: float
) -> None:
    solver, stretch = law
    text = MOORING.replace("SOLVER", solver).replace("STRETCH", stretch)
    mooring = made_mooring(tmp_path, text.replace("LENGTH", f"{length}"))
    depth, u, v, w = drawn(3, CHARACTERS, mooring.water.depth)
    found = solve_profiles(mooring, u, v, depth, w)
    assert_as_run(found, mooring, depth, u, v, w)


def test_a_case_without_a_result_has_no_number(tmp_path: Path) -> None:
    text = MOORING.replace("SOLVER", "friction: berteaux").replace("STRETCH", STIFF)
    mooring = made_mooring(tmp_path, text.replace("LENGTH", "90"))
    depth, u, v, w = drawn(3, 12, mooring.water.depth)
    u[3] = np.nan
    v[7, 2] = 40.0
    found = solve_profiles(mooring, u, v, depth, w)
    failed = found.status != 0
    assert failed[[3, 7]].all()
    for name, values in vars(found).items():
        if isinstance(values, np.ndarray) and values.dtype.kind == "f":
            assert np.isnan(values[failed]).all(), name
            if name.endswith("knockdown"):  # slack in still water, it has no shape there
                assert np.isnan(values[:, 0]).all(), name
            elif name != "other_used_buoyancy":  # there is no other equilibrium
                assert np.isfinite(values[~failed]).all(), name
    assert (found.used_buoyancy[~failed] < 1.0).any()  # it floats in some


CHAIN = "  - {use: rope, length: LENGTH m}\n  - {use: chain, length: 60 m}"


@pytest.mark.parametrize("chain", [False, True], ids=["hanging", "with 60 m of chain"])
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())
def test_a_profile_is_solved_alike_alone_and_in_any_company(
    tmp_path: Path, law: tuple[str, str], chain: bool
) -> None:
    """Byte for byte: what a profile leaves behind is nothing to the next."""
    solver, stretch = law
    text = MOORING.replace("SOLVER", solver).replace("STRETCH", stretch)
    if chain:
        text = text.replace("  - {use: rope, length: LENGTH m}", CHAIN)
        text = text.replace("\nline:", "\n  chain: {kind: chain, diameter: 13 mm}\nline:")
    batch = Batch(made_mooring(tmp_path, text.replace("LENGTH", "60")))
    depth, u, v, w = drawn(5, CHARACTERS, batch.water.depth)
    together = batch.solve(u, v, depth, w)
    order = np.random.default_rng(1).permutation(len(u))
    for few in [order, *([case] for case in order)]:
        others = vars(batch.solve(u[few], v[few], depth if depth.ndim == 1 else depth[few], w[few]))
        for name, values in vars(together).items():
            if isinstance(values, np.ndarray):
                assert others[name].tobytes() == values[few].tobytes(), name
