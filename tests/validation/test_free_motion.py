"""Lines that rise, against their continuous solution in the same sheared current."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import calm
from calm.case import Design
from calm.physics.drag import Friction
from calm.physics.line import Line, Water
from calm.shipped import shipped_folder
from calm.solve import part_of, solve_rise
from tests.validation.drifting import rising
from tests.validation.loads import Vector

WITHIN = 1e-4
"""Of the vertical speed: what is promised at 1°. The worst found is 7e-5, in the drift of a chain
and rope with a free end, and 4e-6 in the vertical."""

VERTICALLY = 1e-5

SHEARED = (
    "s1000",
    "taut-nylon-surface",
    "tidal-adcp",
    "veering-current",
    *(
        pytest.param(name, marks=pytest.mark.thorough)
        for name in (
            "cdms-1",
            "chain-and-rope-surface",
            "deep-current-meters",
            "fit-top-depth",
            "sediment-trap-undercurrent",
            "thermistor-string",
            "upward-adcp-300m",
        )
    ),
)
MOORINGS = (*SHEARED, "braconnot-buoy", "receiver-line")


def moored(name: str) -> Design:
    """A shipped mooring."""
    mooring = calm.load(shipped_folder("lines") / f"{name}.yaml")
    return mooring


def strongest(line: Line, force: Vector) -> int:
    """The piece below which the line is pulled most."""
    return int(np.argmax(force[:, 2])) + 1


def agree(velocity: Vector, reference: Vector) -> None:
    off = np.abs(velocity - reference) / abs(reference[2])
    assert off[2] <= VERTICALLY
    assert off.max() <= WITHIN


def rises_as_the_continuous_line(line: Line, water: Water) -> None:
    top = 0.2 * water.depth
    motion = solve_rise(line, water, top)
    split = strongest(line, motion.solution.force[motion.solution.piece_nodes[:, 1]])
    parts = part_of(line, 0, split), part_of(line, split, len(line.length))
    agree(motion.velocity, rising(*parts, water, top, 1.01 * motion.velocity))


@pytest.mark.parametrize("name", SHEARED)
def test_the_rise_is_that_of_the_continuous_line(name: str) -> None:
    rises_as_the_continuous_line(moored(name).line, moored(name).water)


@pytest.mark.parametrize("friction", [Friction.HOERNER, Friction.CONSTANT])
def test_other_laws_of_friction(friction: Friction) -> None:
    mooring = moored("deep-current-meters")
    rises_as_the_continuous_line(replace(mooring.line, friction=friction), mooring.water)


@pytest.mark.parametrize("name", MOORINGS)
def test_every_shipped_mooring_rises(name: str) -> None:
    mooring = moored(name)
    motion = solve_rise(mooring.line, mooring.water, 0.1 * mooring.water.depth)
    assert motion.solution.closure <= 1e-6
    assert motion.tangles == ()
    assert motion.velocity[2] > 0.0


@pytest.mark.parametrize("name", SHEARED)
def test_a_finer_march_changes_little(name: str) -> None:
    mooring = moored(name)
    finer = replace(mooring.settings, angle_step=0.5 * mooring.settings.angle_step)
    coarse, fine = (
        solve_rise(mooring.line, mooring.water, 0.2 * mooring.water.depth, settings)
        for settings in (mooring.settings, finer)
    )
    agree(coarse.velocity, fine.velocity)
