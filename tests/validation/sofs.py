"""Moorings of the Southern Ocean Flux Station and the tensions measured below their buoys.

`sofs1.yaml` and `sofs5.yaml` have the figures of their decks for WHOI Cable, with a smaller table
of the hull. The other lines differ from SOFS-1 as their decks do. Tensions: IMOS, by bins of
significant height, with the peak period that the load cases of the station pair with it; bins with
less than 50 hours of the year are left out.

Source: petejan/sots-cable-model, `sofs/`: decks, materials.cbl and SOFS-load-stats.mat. Its unit is
the kgf: it is drawn beside computed newtons over 9.81. Tensions were sampled at 5 Hz for ten
minutes at a time, the heights come from the acceleration of the buoy in the same ten minutes
(petejan/java-ocean-data-delivery, WriteMRU_SOFS and WaveCalculator).
"""

from functools import cache
from pathlib import Path

import numpy as np

from calm.case import load
from calm.case.leg import Leg
from calm.records.sea_states import spectrum_of
from calm.waves.analysis import WaveAnalysis, analyse
from calm.waves.measured import COMPARED, HIGHEST_LOW_SEA, measured_band

KGF = 9.80665

SEAS = (
    (1.5, 5.28), (2.5, 6.10), (3.5, 7.07), (4.5, 7.96), (5.5, 8.84), (6.5, 9.67), (7.5, 10.46),
    (8.5, 11.32), (9.5, 12.21),
)  # fmt: skip
"""Significant height [m], peak period of the load cases [s]."""

NONE = np.nan
MEASURED = {
    "SOFS-1": (92, 103, 138, 161, 174, 190, 193, 204, 143),
    "SOFS-3": (NONE, 143, 168, 189, 207, 221, 241, 255, 271),
    "SOFS-4": (117, 135, 175, 205, 227, 245, 260, 280, 292),
    "SOFS-5": (129, 157, 190, 212, 244, 265, 283, 300, 317),
    "SOFS-6": (NONE, 95, 117, 138, 154, 170, 183, 193, 202),
}
"""Standard deviation of the tension [kgf] in these seas."""

ODD = ("SOFS-1", 9.5)
"""A bin in which the tension falls by a third, while its mean rises: of other times, or seas."""

_CAGE_AT_200 = """\
- {use: sofscage, length: 1 m}
- {use: pivot}
- {use: term-b, length: 0.3 m}
- {use: pivot}
- {use: torqbal-7-16in, length: 300 m}
"""
_WIRE_TO_500 = "- {use: torqbal-7-16in, length: 300 m}\n"
_JOINED = "- {use: pivot}\n- {use: term-b, length: 0.3 m}\n- {use: pivot}\n"

_SPLICED = "- {use: term-splice, length: 0.5 m}\n- {use: pivot}\n"
_CHAIN = "chain-7-8in: {kind: chain, diameter: 79.5 mm, cn: 0.55, ct: 0.05, weight: 86.0182056 N/m"
_CAGE = "diameter: 0.2 m, cn: 1, ct: 0.1, weight: 225.134956 N/m, mass: 30 kg/m"

_EDITS = {
    "SOFS-1": (),
    # one wire and one nylon are left open in the deck of SOFS-4 and taken as those of SOFS-3; the
    # cages of both have slips (134 and 1.35 kg/m), and here the mass that materials.cbl corrects to
    "SOFS-3": (
        ("depth: 4400 m", "depth: 4650 m"),
        ("[4400, 0.06, 0]", "[4650, 0.06, 0]"),
        (_CAGE_AT_200, _WIRE_TO_500 + _JOINED + "- {use: sofscage, length: 1.85 m}\n"),
        ("- {use: sofscage, length: 1 m}", "- {use: sofscage, length: 1.85 m}"),
        ("- {use: nylon-7-8in, length: 2000 m}", "- {use: nylon-7-8in, length: 2200 m}"),
        (_SPLICED, ""),
        ("- {use: term-trans, length: 0.145 m}", "- {use: term-d, length: 0.145 m}"),
        (_CHAIN, _CHAIN.replace("79.5 mm", "68.1 mm").replace("86.0182056", "73.7084")),
        ("mass: 10.08\n      kg/m", "mass: 8.643 kg/m"),
        (_CAGE, "diameter: 0.6 m, cn: 1, ct: 0.1, weight: 122 N/m, mass: 16.3 kg/m"),
        (
            "  term-e:",
            "  term-d: {kind: cable, diameter: 88.9 mm, cn: 0.55, ct: 0.05, weight: 134.6 N/m,\n"
            "    mass: 15.77 kg/m, stiffness: 130000 kN}\n  term-e:",
        ),
        ("weight: 21000 N", "weight: 22000 N"),
    ),
    "SOFS-6": (
        ("depth: 4400 m", "depth: 4600 m"),
        ("[4400, 0.06, 0]", "[4600, 0.06, 0]"),
        (_CAGE_AT_200, _WIRE_TO_500),
        (
            "- {use: torqbal-3-8in, length: 100 m}",
            "- {use: sofscage, length: 1 m}\n- {use: pivot}\n- {use: term-c, length: 0.275 m}\n"
            "- {use: pivot}\n- {use: torqbal-3-8in, length: 100 m}",
        ),
        ("- {use: nystron-7-8in, length: 90 m}", "- {use: nystron-7-8in, length: 200 m}"),
        ("- {use: nylon-7-8in, length: 2000 m}", "- {use: nylon-7-8in, length: 2200 m}"),
        ("weight: 21000 N", "weight: 22000 N"),
    ),
}

_LONG_CAGES = (
    ("- {use: sofsawcp, length: 1 m}", "- {use: sofsawcp, length: 1.85 m}"),
    ("- {use: sofsadcp, length: 1 m}", "- {use: sofsadcp, length: 1.85 m}"),
)
"""The deck of SOFS-5 makes its two cages 1 m long, with the mass and weight per metre of cages of
1.85 m: by its own comments they have 100 and 137 kg, not 54 and 74."""


def mooring(name: str, *, whole_cages: bool = False, heave: str | None = None) -> Leg:
    """Return a line by its name; the cages of SOFS-5 with their whole mass, a way to heave."""
    file = "sofs5.yaml" if name == "SOFS-5" else "sofs1.yaml"
    edits = _EDITS.get("SOFS-3" if name == "SOFS-4" else name, ())
    edits += _LONG_CAGES if whole_cages else ()
    if heave is not None:
        edits += (("    role: float\n", f"    role: float\n    heave: {heave}\n"),)
    path = Path(__file__).parent / file
    text = path.read_text()
    for old, new in edits:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return load(path, text=text).leg


def seas():
    """Return the seas of the bins."""
    return [spectrum_of("bretschneider", height, period, 3.3) for height, period in SEAS]


def at_the_top(analysis: WaveAnalysis) -> np.ndarray:
    """Return the standard deviation of the tension below the float in each sea [kgf]."""
    return np.array([state.components[2].tension_std for state in analysis.states]) / KGF


@cache
def ratios(name: str, **how) -> dict[float, float]:
    """Return computed over measured standard deviations by significant height, but no odd bin."""
    found = at_the_top(analyse(mooring(name, **how), seas(), 90.0)) / MEASURED[name]
    return {
        height: float(ratio)
        for (height, _), ratio in zip(SEAS, found, strict=True)
        if np.isfinite(ratio) and (name, height) != ODD
    }


def holds_the_five_lines(heave: str) -> None:
    """Assert that the bands of the report hold all lines, and end within 10 % of the outermost.

    SOFS-5 is taken by its deck, and with the whole mass of its cages.
    """
    how = {} if heave == "filtered" else {"heave": heave}
    lines = [ratios(name, **how) for name in MEASURED]
    lines.append(ratios("SOFS-5", whole_cages=True, **how))
    for low, high in ((COMPARED[0], HIGHEST_LOW_SEA), (HIGHEST_LOW_SEA, COMPARED[1])):
        found = [1.0 / line[at] for line in lines for at in line if low < at < high]
        band = measured_band(0.5 * (low + high), heave)
        assert (band.from_height, band.to_height) == (low, high)
        assert band.low <= min(found) <= 1.1 * band.low
        assert 0.9 * band.high <= max(found) <= band.high
