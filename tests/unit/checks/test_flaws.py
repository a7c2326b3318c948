"""Sound lines, each with one deliberate flaw: which rule catches it, and what it says."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import pytest

from calm.case import load
from calm.checks.assess import ONCE, RULES
from calm.checks.design_check import assessment_of, environments_checked
from calm.checks.finding import Finding
from calm.shipped import shipped_folder
from tests.judged import without_checks


@dataclass(frozen=True)
class Flaw:
    """A line of `lines/`, what is written in it instead of what, and the finding that follows."""

    name: str
    line: str
    changes: tuple[tuple[str, str], ...]
    rule: str
    component: str | None
    state: str
    says: str
    situation: str = "as given"


AT_LEAST = (
    "profiler",
    "current",
    "strength-steps",
    "anchor-weight",
    "slack",
    "wave-slack",
    "fatigue",
    "reserve",
    "freeboard",
    "backup",
    "recovery",
    "top-depth",
    "fish-bite",
)
"""Rules whose values may not fall short of their limits; those of the others may not pass them."""
TOLD = ("scope", "drag-coefficient")
"""Rules that judge nothing, or warn in no shipped line: for drag see `test_curves`."""

UNDER = (
    ("[0, 0.70, 290]", "[0, 2.9, 290]"),
    ("[80, 0.60, 285]", "[80, 2.5, 285]"),
    ("label: five wheels, weight: 17.16 kN}", "label: five wheels, weight: 60 kN}"),
)
"""A current that takes a buoy under whose anchor holds."""

CDMS, SLOPE, NYLON, FIT = "cdms-1", "upward-adcp-300m", "taut-nylon-surface", "fit-top-depth"

GUARD = "chain-and-rope-surface"
IN_WAVES = (
    ("depth: 60 m", "depth: 60 m\n  waves: {significant_height: 3 m, peak_period: 7 s}"),
    ("label: marker buoy}", "label: marker buoy, heave: follows, mass: 200 kg}"),
)
NOT_ACCEPTED = ("    - rule: wave-strength\n", "    - rule: knockdown\n")
STRETCHING = ("label: floating rope}", "label: floating rope, stiffness: 60 kN}")

FLAWS = (
    Flaw(
        "a buoy that nobody looked at in waves",
        GUARD,
        (NOT_ACCEPTED,),
        "wave-strength",
        None,
        "unknown",
        "The environment has no `waves:`",
    ),
    Flaw(
        "a link too weak for a sea",
        GUARD,
        (
            NOT_ACCEPTED,
            *IN_WAVES,
            ("{use: polypropylene-22", "{use: polypropylene-22, breaking_load: 6.68 kN"),
            STRETCHING,
        ),
        "wave-strength",
        "floating rope",
        "fail",
        "; the limit is 4.00 kN",
    ),
    Flaw(
        "a rope whose stretch in waves is not known",
        GUARD,
        (NOT_ACCEPTED, *IN_WAVES),
        "wave-strength",
        "floating rope",
        "unknown",
        "has no `stiffness`",
    ),
    Flaw(
        "a line that snatches",
        GUARD,
        (*IN_WAVES, STRETCHING, ("significant_height: 3 m", "significant_height: 6 m")),
        "wave-slack",
        "floating rope",
        "fail",
        "the line goes slack and snap loads follow",
    ),
    Flaw(
        "a life without a climate",
        GUARD,
        (*IN_WAVES, STRETCHING),
        "fatigue",
        None,
        "not-judged",
        "A fatigue life needs a wave climate",
    ),
    Flaw(
        "a wire too weak",
        CDMS,
        (("stiffness: 5311 kN", "stiffness: 5311 kN\n    working_load: 5 kN"),),
        "strength",
        "wire",
        "fail",
        "its working load is 5.00 kN",
    ),
    Flaw(
        "a breaking load less than thrice the pull",
        CDMS,
        (("stiffness: 5311 kN", "stiffness: 5311 kN\n    breaking_load: 15 kN"),),
        "strength",
        "wire",
        "fail",
        "its breaking load of 15.00 kN divided by 3 allows 5.00 kN",
    ),
    Flaw(
        "a rope that needs 5, not 3",
        CDMS,
        (("stiffness: 2655 kN", "stiffness: 2655 kN\n    breaking_load: 30 kN"),),
        "strength",
        "Kevlar 1",
        "fail",
        "divided by 5 allows 6.00 kN",
    ),
    Flaw(
        "no load known",
        CDMS,
        (),
        "missing",
        "wire",
        "unknown",
        "its working load and breaking load are unknown",
    ),
    Flaw(
        "one weak shackle in a strong line",
        SLOPE,
        (
            (
                "{use: shackle-19}\n  - {use: swivel",
                "{use: shackle-19, working_load: 1 kN}\n  - {use: swivel",
            ),
        ),
        "strength",
        "shackle-19 1",
        "fail",
        "its working load is 1.00 kN",
    ),
    Flaw(
        "a weak link between strong neighbours",
        SLOPE,
        (
            (
                "{use: shackle-13}\n  - {use: rcm11, label: meter 500 m}",
                "{use: shackle-13, working_load: 1 kN}\n  - {use: rcm11, label: meter 500 m}",
            ),
        ),
        "strength-steps",
        "shackle-13 1",
        "warn",
        "is rated for 1.00 kN",
    ),
    Flaw(
        "an anchor lighter than the rule",
        CDMS,
        (),
        "anchor-weight",
        "deadweight",
        "fail",
        "is required",
    ),
    Flaw(
        "an anchor that the line almost lifts",
        CDMS,
        (("weight: 1350 kgf", "weight: 1000 kgf"),),
        "anchor-uplift",
        "deadweight",
        "fail",
        "The vertical anchor load is",
    ),
    Flaw(
        "a bed that does not hold",
        CDMS,
        (("weight: 1350 kgf", "weight: 1350 kgf\n    friction: 0.1"),),
        "anchor-sliding",
        "deadweight",
        "fail",
        "a friction coefficient of 0.1 holds",
    ),
    Flaw(
        "a rope almost slack",
        CDMS,
        (
            ("buoyancy: 682 kgf", "buoyancy: 80 kgf"),
            ("[0, 1.5, 90]", "[0, 0.1, 90]"),
            ("[200, 0.6, 90]", "[200, 0.1, 90]"),
        ),
        "slack",
        "Kevlar 3",
        "fail",
        "a rope needs 300 N to stay taut",
    ),
    Flaw(
        "an instrument that leans too much",
        SLOPE,
        (
            (
                "{use: rcm11, label: meter 1500 m}",
                "{use: rcm11, label: meter 1500 m, max_tilt: 1 deg}",
            ),
        ),
        "tilt",
        "meter 1500 m",
        "fail",
        "the limit is 1.0°",
    ),
    Flaw(
        "an instrument whose data become doubtful",
        SLOPE,
        (
            (
                "{use: rcm11, label: meter 1500 m}",
                "{use: rcm11, label: meter 1500 m, warn_tilt: 1 deg}",
            ),
        ),
        "tilt",
        "meter 1500 m",
        "warn",
        "its data are unreliable",
    ),
    Flaw(
        "a tilt that the design forbids",
        SLOPE,
        (("maximum_tilt: 15 deg", "maximum_tilt: 0.5 deg"),),
        "tilt",
        "meter 500 m",
        "fail",
        "the limit is 0.5°",
    ),
    Flaw(
        "a clamp below its depth",
        SLOPE,
        (("at: 399 m, label: CTD 900 m}", "at: 399 m, label: CTD 900 m, depth_rating: 950 m}"),),
        "depth-rating",
        "CTD 900 m",
        "fail",
        "its depth rating of 950 m less a margin of 100 m allows 850 m",
    ),
    Flaw(
        "a float whose depth is not known",
        CDMS,
        (),
        "missing",
        "sphere",
        "unknown",
        "its depth rating is unknown",
    ),
    Flaw(
        "a knockdown that the design forbids",
        SLOPE,
        (("maximum_knockdown: 25 m", "maximum_knockdown: 2 m"),),
        "knockdown",
        "ADCP float",
        "fail",
        "the limit is 2.0 m",
    ),
    Flaw(
        "an excursion that the design forbids",
        SLOPE,
        (("maximum_knockdown: 25 m", "maximum_excursion: 20 m"),),
        "excursion",
        "ADCP float",
        "fail",
        "the limit is 20.0 m",
    ),
    Flaw(
        "a buoy with little in reserve",
        NYLON,
        (("checks:\n", "checks:\n  minimum_reserve: 0.9\n"),),
        "reserve",
        "buoy",
        "fail",
        "at least 90 % is required",
    ),
    Flaw(
        "a watch circle beyond the chart's",
        "chain-and-rope-surface",
        (("checks:\n", "checks:\n  maximum_excursion: 5 m\n"),),
        "watch-circle",
        None,
        "fail",
        "The watch circle has a radius of",
    ),
    Flaw(
        "no back-up glass",
        SLOPE,
        (("  - {use: glass-cluster-4, count: 3, label: back-up glass}\n", ""),),
        "backup",
        None,
        "fail",
        "the section with the release has a net buoyancy of",
    ),
    Flaw(
        "a release that nothing is told of",
        CDMS,
        (("    role: release\n", ""),),
        "backup",
        None,
        "unknown",
        "The line has no release",
    ),
    Flaw(
        "a line that hardly rises",
        CDMS,
        (
            ("buoyancy: 682 kgf", "buoyancy: 75 kgf"),
            ("{use: glass, count: 10}", "{use: glass}"),
            ("[0, 1.5, 90]", "[0, 0.05, 90]"),
            ("[200, 0.6, 90]", "[200, 0.05, 90]"),
            ("[525, 0.1, 90]", "[525, 0.05, 90]"),
        ),
        "recovery",
        None,
        "warn",
        "the line rises at",
    ),
    Flaw(
        "a parafil that breaks in the launch",
        SLOPE,
        (("label: parafil 1}", "label: parafil 1, breaking_load: 12 kN}"),),
        "launch-strength",
        "parafil 1",
        "fail",
        "its breaking load divided by 2 is 6.00 kN",
    ),
    Flaw(
        "an anchor that falls like a stone",
        SLOPE,
        (
            (
                "{use: anchor-wheels-4, label: four wheels}",
                "{use: anchor-wheels-4, label: four wheels, weight: 60 kN, kt: 10 N/(m/s)^2}",
            ),
        ),
        "launch-speed",
        "four wheels",
        "warn",
        "the limit is 2.5 m/s",
    ),
    Flaw(
        "an anchor lifted at high water",
        NYLON,
        (("  depth: 2000 m\n", "  depth: 2000 m\n  depth_range: [1995 m, 2600 m]\n"),),
        "equilibrium",
        None,
        "fail",
        "anchor-lifts",
        "high water",
    ),
    Flaw(
        "a current that takes the buoy under",
        NYLON,
        UNDER,
        "reserve",
        "buoy",
        "fail",
        "under water and has no reserve buoyancy",
    ),
    Flaw(
        "a buoy too small to come up",
        NYLON,
        (
            (
                "use: buoy-toroid-8ft",
                "use: sphere-steel-1250, mass: 100 kg, diameter: 1 m, length: 1 m, buoyancy: 4 kN",
            ),
        ),
        "reserve",
        "buoy",
        "fail",
        "under water and has no reserve buoyancy",
    ),
    Flaw(
        "a buoy without freeboard",
        NYLON,
        UNDER,
        "freeboard",
        "buoy",
        "fail",
        "m under water",
    ),
    Flaw(
        "a line that does not rise",
        CDMS,
        (
            ("buoyancy: 682 kgf", "buoyancy: 75 kgf"),
            ("{use: glass, count: 10}", "{use: glass}"),
            ("{use: release}", "{use: release, buoyancy: -34 kgf}"),
            ("{use: chain, length: 4.8 m}", "{use: chain, length: 0.01 m}"),
            ("[0, 1.5, 90]", "[0, 0.05, 90]"),
            ("[200, 0.6, 90]", "[200, 0.05, 90]"),
            ("[525, 0.1, 90]", "[525, 0.05, 90]"),
        ),
        "recovery",
        "release",
        "fail",
        "0.30 m/s is required",
    ),
    Flaw(
        "back-up glass that overtakes the line",
        SLOPE,
        (
            (
                "{use: float-stablemoor-1000lb, label: ADCP float}",
                "{use: float-stablemoor-1000lb, label: ADCP float, buoyancy: 2500 N}",
            ),
            ("count: 3, label: back-up glass", "count: 12, label: back-up glass"),
        ),
        "tangling",
        None,
        "warn",
        "the line doubles back and may tangle",
    ),
    Flaw(
        "growth that takes the top down",
        SLOPE,
        (
            (
                "  depth: 1800 m\n",
                "  depth: 1800 m\n  fouling: {depth: 1000 m, thickness: 30 mm}\n",
            ),
            ("maximum_knockdown: 25 m", "maximum_knockdown: 13 m"),
        ),
        "knockdown",
        "ADCP float",
        "fail",
        "the limit is 13.0 m",
        "fouling",
    ),
    Flaw(
        "cables that strum take the top down",
        SLOPE,
        (("maximum_knockdown: 25 m", "maximum_knockdown: 13 m"),),
        "knockdown",
        "ADCP float",
        "warn",
        "the limit is 13.0 m",
        "strumming",
    ),
    Flaw(
        "a top that hulls and nets reach",
        FIT,
        (
            ("top_depth: 105 m", "top_depth: 2 m"),
            ("[0, 0.80, 90]", "[0, 0.2, 90]"),
            ("[200, 0.35, 80]", "[200, 0.1, 80]"),
        ),
        "top-depth",
        None,
        "warn",
        "at least 10.0 m is needed to stay clear",
    ),
    Flaw(
        "a top less deep than the design says",
        SLOPE,
        (("maximum_knockdown: 25 m", "minimum_top_depth: 400 m"),),
        "top-depth",
        "ADCP float",
        "fail",
        "at least 400.0 m is needed to stay clear",
    ),
    Flaw(
        "a release that the line overloads",
        FIT,
        (("{use: release-ar861", "{use: release-ar861, working_load: 1 kN"),),
        "release-load",
        None,
        "fail",
        "the limit is 1.00 kN",
    ),
    Flaw(
        "a release that does not open under its load",
        FIT,
        (
            (
                "{use: release-ar861",
                "{use: release-ar861, working_load: 25 kN, opening_load: 1 kN",
            ),
        ),
        "release-load",
        None,
        "fail",
        "its opening load is 1.00 kN",
    ),
    Flaw(
        "a release of estimated working load that does not open under its load",
        FIT,
        (("{use: release-ar861", "{use: release-ar861, opening_load: 1 kN"),),
        "release-load",
        None,
        "fail",
        "its opening load is 1.00 kN",
    ),
    Flaw(
        "a release of estimated working load that the line breaks",
        FIT,
        (("{use: release-ar861", "{use: release-ar861, breaking_load: 6 kN"),),
        "strength",
        "release",
        "fail",
        "its breaking load of 6.00 kN divided by 3 allows 2.00 kN",
    ),
    Flaw(
        "a lake, in which floats have less buoyancy",
        CDMS,
        (
            ("[0, 1024]", "[0, 1000]"),
            ("[200, 1025]", "[200, 1000]"),
            ("[525, 1026]", "[525, 1000]"),
        ),
        "environment",
        "sphere",
        "warn",
        "the displaced water weighs 2.4 % less",
    ),
    Flaw(
        "a sub-surface line without a release",
        CDMS,
        (("    role: release\n", ""),),
        "release-present",
        None,
        "unknown",
        "the release of the line is unknown",
    ),
    Flaw(
        "a release with no other beside it",
        FIT,
        (),
        "release-present",
        "release",
        "warn",
        "release is the only release: if it fails, the line stays moored.",
    ),
    Flaw(
        "a release on its anchor",
        SLOPE,
        (
            (
                "  - {use: polyester-19-dewey, length: 15 m, label: drop line, "
                "breaking_load: 49.8 kN}\n  - {use: chain-buoy-16, length: 5 m, "
                "label: chain above the anchor}\n",
                "",
            ),
            ("release-pair-ar861, label: releases}", "release-ar861-double, label: releases pair}"),
        ),
        "release-present",
        "releases pair",
        "warn",
        "releases pair is 0.1 m above the anchor; a release needs at least 1 m",
    ),
    Flaw(
        "a release above every float",
        CDMS,
        (
            ("  - {use: sphere}\n", "  - {use: release}\n"),
            ("  - {use: glass, count: 10}\n  - {use: release}\n", "  - {use: sphere}\n"),
        ),
        "release-present",
        "release",
        "fail",
        "No piece above release is buoyant, so the release stays on the seabed when it opens.",
    ),
    Flaw(
        "a release that is clamped",
        SLOPE,
        (("at: 399 m, label: CTD 900 m}", "at: 399 m, label: CTD 900 m, role: release}"),),
        "release-present",
        "CTD 900 m",
        "unknown",
        "CTD 900 m has `role: release`, but a clamped release cannot free the line.",
    ),
    Flaw(
        "a line without any shackle",
        CDMS,
        (),
        "hardware",
        None,
        "warn",
        "its joints are not checked",
    ),
    Flaw(
        "a rope where fish bite",
        FIT,
        (),
        "fish-bite",
        "polyester",
        "warn",
        "rope above 1000.0 m is exposed to fish bite",
    ),
    Flaw(
        "a release above every float, beside a good one",
        FIT,
        (
            (
                "  - {use: sphere-steel",
                "  - {use: release-ar861, label: upper}\n  - {use: sphere-steel",
            ),
        ),
        "release-present",
        "upper",
        "warn",
        "No piece above release upper is buoyant",
    ),
    Flaw(
        "a nylon rope without stiffness",
        CDMS,
        (("stiffness: 2655 kN\n    material: aramid", "material: nylon"),),
        "missing",
        "Kevlar 3",
        "unknown",
        "is nylon of unknown stiffness and is assumed inextensible. The rope could stretch by",
    ),
    Flaw(
        "a rope measured under most of what it bears",
        FIT,
        (
            (
                "    length: 480 m\n    label: wire",
                "    length_at: {load: 22 kN, length: 480 m}\n    label: wire",
            ),
        ),
        "stretch",
        "wire",
        "warn",
        "wire is to be cut to length under a load of 22.00 kN; this load exceeds",
    ),
    Flaw(
        "a float that leaps",
        SLOPE,
        (
            ("label: ADCP float}", "label: ADCP float, buoyancy: 30 kN}"),
            ("label: four wheels}", "label: four wheels, weight: 90 kN}"),
        ),
        "recovery",
        None,
        "warn",
        "above 3 m/s floats may breach and the line may loop.",
    ),
    Flaw(
        "a clamp that slips",
        SLOPE,
        (("at: 399 m, label: CTD 900 m}", "at: 399 m, label: CTD 900 m, grip: 1 N}"),),
        "clamp-grip",
        "CTD 900 m",
        "fail",
        "the grip of the clamp is 1.00 N",
    ),
    Flaw(
        "a wire that winds up its float",
        FIT,
        (("{use: swivel-miller-c212, label: swivel}", "{use: shackle-16, label: swivel}"),),
        "swivel",
        "wire",
        "warn",
        "there is no swivel between it and",
    ),
    Flaw(
        "a wire that is not torque-balanced, as its material says",
        FIT,
        (
            ("{use: swivel-miller-c212, label: swivel}", "{use: shackle-16, label: swivel}"),
            ("    label: wire\n", "    label: wire\n    note: NOT torque-balanced\n"),
        ),
        "swivel",
        "wire",
        "warn",
        "there is no swivel between it and",
    ),
    Flaw(
        "a wire that is not torque-balanced, whatever its name says",
        FIT,
        (
            ("{use: swivel-miller-c212, label: swivel}", "{use: shackle-16, label: swivel}"),
            (
                "    label: wire\n",
                "    label: wire\n    note: torque-balanced\n    torque_balanced: false\n",
            ),
        ),
        "swivel",
        "wire",
        "warn",
        "wire is not torque-balanced, and there is no swivel between it and top float",
    ),
    Flaw(
        "a shackle for a release",
        FIT,
        (("{use: release-", "{name: shackle 13, use: release-"),),
        "release-present",
        None,
        "unknown",
        "has `role: release`, but its name suggests another component.",
    ),
    Flaw(
        "two clamps in one place",
        FIT,
        (("at: 20 m, label: CTD 130 m", "at: 5.3 m, label: CTD 130 m"),),
        "clamp-place",
        "CTD 130 m",
        "fail",
        "CTD 130 m overlaps hydrophone by 0.67 m on wire.",
    ),
    Flaw(
        "a clamp over the end of its wire",
        FIT,
        (("at: 120 m, label: CTD 230 m", "at: 479.9 m, label: CTD 230 m"),),
        "clamp-place",
        "CTD 230 m",
        "fail",
        "CTD 230 m extends 0.21 m beyond the end of wire.",
    ),
    Flaw(
        "a current weaker than a breeze drives",
        FIT,
        (
            ("[0, 0.80, 90]", "[0, 0.08, 90]"),
            ("[200, 0.35, 80]", "[200, 0.08, 80]"),
            ("[600, 0.15, 70]", "[600, 0.08, 70]"),
        ),
        "current",
        None,
        "warn",
        "The strongest current checked is 0.08 m/s; a wind of 7 m/s alone drives a surface "
        "current of 0.20 m/s",
    ),
    Flaw(
        "a rope that no water drags",
        FIT,
        (("    label: wire\n", "    label: wire\n    cn: 0.001\n"),),
        "figures",
        "wire",
        "fail",
        "wire has `cn: 0.001`; a cable has at least 0.05 and at most 4",
    ),
    Flaw(
        "a load that a catalogue's piece does not bear",
        FIT,
        (
            (
                "  - {use: shackle-13}\n  - {use: rcm11",
                "  - {use: shackle-13, working_load: 90 kN}\n  - {use: rcm11",
            ),
        ),
        "figures",
        None,
        "unknown",
        "The line sets working_load of shackle-13 to 90.00 kN without a source; the value in",
    ),
    Flaw(
        "a rope that no current pushes",
        FIT,
        (("label: polyester,", "label: polyester, cn: 0.2,"),),
        "figures",
        None,
        "unknown",
        "The line sets cn of polyester to 0.2 without a source; the value in the definition of "
        "polyester-19-dewey",
    ),
    Flaw(
        "a noble shackle on steel",
        FIT,
        (
            (
                "  - {use: shackle-13}\n  - {use: rcm11",
                "  - {use: shackle-13, material: titanium}\n  - {use: rcm11",
            ),
        ),
        "metals",
        "wire",
        "warn",
        "0.66 V nobler in sea water",
    ),
    Flaw(
        "a profiler with an instrument in its way",
        SLOPE,
        (
            (
                "at: 1 m, label: CTD 295 m}",
                "at: 80 m, label: CTD 295 m}, {use: rider, label: MMP, "
                "between: [swivel, meter 500 m]}",
            ),
            (
                "line:\n",
                "components:\n  rider: {kind: profiler, length: 1.3 m, mass: 70 kg, buoyancy: 0 N, "
                "drag_area: 0.4 m^2, cd: 0.6, drive_force: 50 N, speed: 0.25 m/s}\nline:\n",
            ),
        ),
        "profiler",
        "MMP",
        "fail",
        "CTD 295 m, 80 m down the wire, blocks MMP",
    ),
    Flaw(
        "a shackle of nobody knows what",
        FIT,
        (
            (
                "  - {use: shackle-13}\n  - {use: rcm11",
                "  - {use: shackle-13, label: link, material: hastaloy}\n  - {use: rcm11",
            ),
        ),
        "figures",
        "link",
        "unknown",
        "link has the unknown material `hastaloy`, so its strength, stretch and corrosion",
    ),
    Flaw(
        "a launch that may bear half the working load",
        SLOPE,
        (
            ("length: 200 m, label: wire 1,", "length: 200 m, label: wire 1, working_load: 8 kN,"),
            ("checks:\n", "checks:\n  launch_working_factor: 0.5\n"),
        ),
        "launch-strength",
        "wire 1",
        "fail",
        "its working load times 0.5 is 4.00 kN",
    ),
    Flaw(
        "a breaking load a thousand times too great",
        SLOPE,
        (("length: 200 m, label: wire 1,", "length: 200 m, label: wire 1, breaking_load: 48 MN,"),),
        "figures",
        "wire 1",
        "fail",
        "wire 1 has a breaking load of 48000.00 kN; a cable of its weight in water has at most",
    ),
    Flaw(
        "a wire that floats",
        SLOPE,
        (("length: 200 m, label: wire 1,", "length: 200 m, label: wire 1, buoyancy: 1.2 N/m,"),),
        "figures",
        "wire 1",
        "fail",
        "wire 1 has a buoyancy of 1.2 N/m; water of the same diameter weighs",
    ),
    Flaw(
        "a wire of 250 m in place of 200 m",
        SLOPE,
        (("wire-jacketed-8-5, length: 200 m", "wire-jacketed-8-5, length: 250 m"),),
        "planned-depth",
        "CTD 295 m",
        "fail",
        "CTD 295 m is at 245.0 m in still water; its planned depth is 295.0 m (50.0 m too "
        "shallow).",
    ),
    Flaw(
        "a bottom 250 m deeper than the design",
        SLOPE,
        (("depth: 1800 m", "depth: 2050 m"),),
        "planned-depth",
        None,
        "fail",
        "All 5 parts with a planned depth are",
    ),
    Flaw(
        "deployed where it is deeper",
        SLOPE,
        (("environment:\n", "deployed: {depth: 2100 m}\nenvironment:\n"),),
        "as-deployed",
        None,
        "warn",
        "The mooring was deployed in 2100.0 m of water instead of 1800.0 m. The top of the upright "
        "line is 300.0 m deeper",
    ),
    Flaw(
        "a buoy that no wind blows on",
        NYLON,
        (("  wind: {speed: 14 m/s", "  # wind: {speed: 14 m/s"),),
        "environment",
        "buoy",
        "warn",
        "so the wind load on buoy is not checked",
    ),
    Flaw(
        "a wire straight onto a meter",
        SLOPE,
        (
            (
                "  - {use: shackle-13}\n  - {use: rcm11, label: meter 500 m}\n",
                "  - {use: rcm11, label: meter 500 m}\n",
            ),
        ),
        "joints",
        "wire 1",
        "warn",
        "This joint has no shackle, link or swivel: wire 1 to meter 500 m.",
    ),
    Flaw(
        "a battery of the last deployment",
        SLOPE,
        (
            ("environment:\n", "deployed: {date: 2026-05-01}\nenvironment:\n"),
            ("label: CTD 295 m}", "label: CTD 295 m, battery_until: 2026-01-31}"),
        ),
        "serials-and-dates",
        "CTD 295 m",
        "warn",
        "The battery of CTD 295 m runs out on 2026-01-31; the deployment is on 2026-05-01.",
    ),
    Flaw(
        "a current that no line stands",
        CDMS,
        (("weight: 1350 kgf", "weight: 300 kgf"),),
        "equilibrium",
        None,
        "fail",
        "anchor-lifts",
    ),
)


FIRST = {flaw.rule: flaw.name for flaw in reversed(FLAWS)}
"""A flaw of each rule; the others are for `thorough`."""


@pytest.mark.parametrize(
    "flaw",
    [
        pytest.param(
            flaw,
            id=flaw.name,
            marks=() if FIRST[flaw.rule] == flaw.name else pytest.mark.thorough,
        )
        for flaw in FLAWS
    ],
)
def test_a_flaw_is_caught_by_its_rule(flaw: Flaw, tmp_path: Path) -> None:
    found = [
        finding
        for finding in _findings(flaw, tmp_path)
        if finding.rule == flaw.rule
        and finding.situation == flaw.situation
        and flaw.component in (None, finding.component)
        and (finding.missing is None or flaw.says in finding.message)
    ]
    assert [finding.state for finding in found] == [flaw.state], found
    (finding,) = found
    assert flaw.says in finding.message
    _says_what_it_means(finding)


def test_every_rule_has_its_flaw() -> None:
    assert {flaw.rule for flaw in FLAWS} | set(TOLD) == set(RULES)


def _says_what_it_means(finding: Finding) -> None:
    """The figures, the state and the advice of a finding fit each other."""
    assert finding.source
    if finding.state == "fail":
        assert finding.remedy
        assert finding.margin is None or finding.margin < 0.0
    if finding.value is not None and finding.limit is not None:
        room = finding.limit - finding.value
        at_least = finding.rule in AT_LEAST and "above 3 m/s" not in finding.message
        assert finding.margin == pytest.approx(-room if at_least else room)
    if finding.state == "unknown":
        assert finding.limit is None and finding.margin is None


def _findings(flaw: Flaw, folder: Path) -> Iterable[Finding]:
    if flaw.line == CDMS:  # it accepts whatever the published case leaves open, a failure too
        text = without_checks(flaw.line)
    else:
        text = (shipped_folder("lines") / f"{flaw.line}.yaml").read_text(encoding="utf-8")
    for old, new in flaw.changes:
        assert text.count(old) >= 1, old
        text = text.replace(old, new, 1)
    path = folder / "flawed.yaml"
    path.write_text(text, encoding="utf-8")
    mooring = load(path)
    (stand,) = environments_checked(mooring, "flawed")
    if flaw.rule in {"current", "environment", "missing", *(rule.name for rule in ONCE)}:
        return assessment_of("flawed", [stand]).all_findings()
    return stand.findings  # no launch and no recovery need be computed
