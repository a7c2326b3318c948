"""Materials of components, and their properties."""

import re
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

StiffnessLaw = tuple[float, float]
"""Coefficients a and b of the stiffness law EA = a D² + b D³ [N/m²], [N/m³]."""

STEEL_DENSITY = 7850.0
CONCRETE_DENSITY = 2400.0
LEAD_DENSITY = 11340.0


@dataclass(frozen=True)
class Material:
    """Material with its density, corrosion potential and stiffness.

    Attributes
    ----------
    name : name in files
    words : regular expression for common names of the material, from the beginning of a word
    family : `metal` (corrodes), `fibre` (stretches) or `other`
    density : density of the solid [kg/m³]; None if variable
    potential : middle of the range of corrosion potentials in sea water [V]
    stiffnesses : pairs a, b of published stiffnesses EA = (a + b D) D² of ropes with diameter D
    strength : largest tensile strength of rope wire or yarn [Pa]; None if not used in ropes
    """

    name: str
    words: str
    family: Literal["metal", "fibre", "other"]
    density: float | None = None
    potential: float | None = None
    stiffnesses: tuple[StiffnessLaw, ...] = ()
    strength: float | None = None


MATERIALS = (
    Material(
        "stainless steel",
        r"(?:super )?duplex(?: stainless)?(?: steel)?|stainl\w*(?: steel)?|inox\w*|nirosta"
        r"|(?:a[24]|v[24]a|nitronic ?\d*|(?:aisi |ss ?)?(?:304|316)l?|1\.4\d\d\d?)\b(?: stainless)?"
        r"(?: steel)?",
        "metal", STEEL_DENSITY, -0.05, strength=2160e6,
    ),
    Material("titanium", r"titan\w*|ti\b", "metal", 4500.0, 0.0),
    Material("nickel alloy", r"(?:inconel|hastelloy|monel|nickel)\w*", "metal", 8400.0, 0.0),
    Material("bronze", r"(?:\w+um |nickel |phosphor )?bronze|brass", "metal", 8500.0, -0.35),
    Material("copper", r"copper|cuivre|kupfer|cu\b", "metal", 8900.0, -0.44),
    Material("cast iron", r"(?:cast )?iron|fonte|gusseisen", "metal", 7200.0, -0.66),
    Material(
        "steel",
        r"galv\w*\.?(?: steel)?|hdg|steel\w*|stahl\w*|acier|acero|nilspin",
        "metal", STEEL_DENSITY, -0.66, strength=2160e6,
    ),
    Material("aluminium", r"alumini?um\w*|alu\b", "metal", 2700.0, -0.88),
    Material("zinc", r"zin[ck]", "metal", 7140.0, -1.0),
    Material("lead", r"lead\b|blei|plomb", "metal", LEAD_DENSITY),
    Material(
        "nylon", r"nylon\w*|polyamide?\w*|perlon|pa6?\b", "fibre", 1140.0,
        stiffnesses=((1.18e8, 0.0), (2.71e8, 0.0), (1.035e9, 1.15e9)), strength=960e6,
    ),
    Material(
        "polyester", r"polyester\w*|dacron|terylene", "fibre", 1380.0,
        stiffnesses=((1.09e9, 0.0), (5.42e8, 0.0), (4.312e9, 0.0)), strength=1130e6,
    ),
    Material(
        "polypropylene", r"polypropyl\w*|pp\b", "fibre", 910.0,
        stiffnesses=((1.06e9, 0.0), (2.71e8, 0.0)), strength=620e6,
    ),
    Material(
        "HMPE", r"hmpe|uhmw\w*|dyneema|spectra|plasma|amsteel\w*", "fibre", 975.0,
        stiffnesses=((7.85e10, 0.0), (3.248e10, 3.6456e10)), strength=3500e6,
    ),
    Material(
        "polyethylene", r"polyethyl\w*|hdpe|pe\b", "fibre", 950.0,
        stiffnesses=((5.42e8, 0.0),), strength=620e6,
    ),
    Material("polyolefin", r"polyolefin\w*", "fibre"),
    Material(
        "aramid", r"aramid\w*|kevlar|technora|twaron", "fibre", 1440.0,
        stiffnesses=((5.42e10, 0.0),), strength=3100e6,
    ),
    Material("Vectran", r"vectran|lcp\b", "fibre", 1410.0, strength=3200e6),
    Material("glass", r"(?:fibre|fiber)?glass|verre|glas\b|vitrovex", "other", 2230.0),
    Material("syntactic foam", r"(?:syntactic|pvc)? ?foam|syntactic|mousse", "other"),
    Material("concrete", r"concrete|b[ée]ton|cement", "other", CONCRETE_DENSITY),
    Material(
        "plastic",
        r"plastics?|pvc|pom\b|acetal|delrin|peek|abs\b|polyurethane|pu\b|polycarbonate|nitrile|vinyl",
        "other",
    ),
    Material("rubber", r"rubber|neoprene|epdm", "other"),
    Material("ceramic", r"ceramic\w*|alumina", "other"),
    Material("wood", r"wood\w*|bois", "other"),
)  # fmt: skip
"""All materials of components.

Densities are handbook values. Potentials are the middle of the galvanic series in flowing sea water
(ASTM G82). Galvanised steel has the potential of steel, which is protected by the zinc.

Stiffnesses of ropes are from three sources:

- the tables of OrcaFlex, as adopted by MoorPy (nylon, polyester, polypropylene);
- R. Dewey's Mooring Design & Dynamics, whose moduli are multiplied by πD²/4;
- MoorPy's default properties (nylon 5, polyester 14, HMPE 56 times the breaking load).

The strength of wire is 2160 MPa, the highest usual tensile class for ropes (classes 1570 to 2160 of
EN 12385-4 ropes, as listed by Prolift).

Strengths of yarns differ by at most 17 % from typical strengths published by Tension Technology
International (Synthetic fibre yarn properties): nylon and polyester 0.84 N/tex, polypropylene 0.73,
aramid 2.1, HMPE 3.1, Vectran 2.0.
"""

MATERIAL_NAMES = ", ".join(material.name for material in MATERIALS)

_NAMED = re.compile(
    "|".join(rf"(?P<_{number}>\b(?:{each.words}))" for number, each in enumerate(MATERIALS)),
    re.IGNORECASE,
)
_INSULATED = re.compile(r"plastic|jacket|sheath|coated|insulat", re.IGNORECASE)


@lru_cache(maxsize=1024)
def materials_in(text: str | None) -> tuple[Material, ...]:
    """Find the materials mentioned in a text, in order of appearance."""
    found = _NAMED.finditer(text or "")
    return tuple(MATERIALS[int((match.lastgroup or "_0")[1:])] for match in found)


def density_of(text: str | None) -> float | None:
    """Return the density of the material that a text names [kg/m³].

    Return None if the text names no material, or several materials with different densities.
    """
    densities = {material.density for material in materials_in(text)}
    return densities.pop() if len(densities) == 1 else None


def fibre_of(text: str | None) -> Material | None:
    """Return the fibre of which a rope is made, or None for wire rope with or without a jacket.

    For a blend, the result is the fibre that is named first.
    """
    named = materials_in(text)
    if any(material.family == "metal" and material.name != "lead" for material in named):
        return None
    return next((material for material in named if material.family == "fibre"), None)


def potential_of(text: str | None) -> float | None:
    """Return the corrosion potential in sea water of the noblest metal named in a text [V].

    Return None if the text names no metal, or if the metal is insulated.
    """
    if text is None or _INSULATED.search(text):
        return None
    named = (material.potential for material in materials_in(text))
    return max((volts for volts in named if volts is not None), default=None)


def published_stiffnesses(text: str | None, diameter: float) -> tuple[float, ...]:
    """Return all published values of the stiffness EA [N] of a fibre rope, in increasing order.

    Parameters
    ----------
    text : material of the rope in free text
    diameter : diameter of the rope [m]
    """
    fibre = fibre_of(text)
    laws = fibre.stiffnesses if fibre else ()
    return tuple(sorted((a + b * diameter) * diameter**2 for a, b in laws))
