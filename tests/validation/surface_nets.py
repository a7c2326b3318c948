"""Random surface buoys on two to six legs of wire and chain, as files: alone, turned, mirrored, and
with their legs listed the other way round.

Drawn are buoys that coasts and stations have: 15 to 1200 m of water, chain that lies on the
seabed, legs a tenth to a third longer than the straight way, up to 0.8 m/s. In a current the lee
legs of about one in seven are slack.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, hypot, pi, sin

import numpy as np


@dataclass(frozen=True)
class Part:
    """A piece of a leg: cable or chain where it has a length [m], else a weight.

    Attributes
    ----------
    weight : in water, per metre of what has a length [N or N/m]
    diameter : [m]
    stiffness : EA [N]
    chain : whether it is chain
    """

    length: float
    weight: float
    diameter: float = 0.0
    stiffness: float = 0.0
    chain: bool = False


@dataclass(frozen=True)
class SurfaceNet:
    """A buoy on its legs.

    Attributes
    ----------
    depth : of the water [m]
    top, bottom : current to the east and north at the surface and at the seabed [m/s]
    lift, drag : of the buoy [N], [N/(m/s)²]
    stem : the chain between the buoy and the node
    legs : parts of each from the node down, and its anchor east and north [m]
    """

    depth: float
    top: tuple[float, float]
    bottom: tuple[float, float]
    lift: float
    drag: float
    stem: Part
    legs: tuple[tuple[tuple[Part, ...], tuple[float, float]], ...]

    def still(self) -> SurfaceNet:
        """The same net without current."""
        return replace(self, top=(0.0, 0.0), bottom=(0.0, 0.0))

    def placed(self, matrix: np.ndarray) -> SurfaceNet:
        """The net with its anchors and its current turned or mirrored by a (2, 2) matrix."""

        def moved(at: tuple[float, float]) -> tuple[float, float]:
            east, north = (matrix @ np.array(at)).tolist()
            return east, north

        legs = tuple((parts, moved(at)) for parts, at in self.legs)
        return replace(self, top=moved(self.top), bottom=moved(self.bottom), legs=legs)

    def reordered(self) -> SurfaceNet:
        """The net with its legs listed the other way round."""
        return replace(self, legs=self.legs[::-1])

    @property
    def text(self) -> str:
        """The file."""
        components, legs = [], []

        def line(name: str, parts: tuple[Part, ...]) -> list[str]:
            used = []
            for i, part in enumerate(parts):
                key = f"{name}{i}"
                if part.length == 0.0:
                    components.append(
                        f"  {key}: {{kind: body, length: 0 m, buoyancy: {-part.weight!r} N, "
                        "kn: 3 N/(m/s)^2, inclination: insensitive}"
                    )
                    used.append(f"      - {{use: {key}}}")
                    continue
                kind, drags = ("chain", (2.75, 0.46)) if part.chain else ("cable", (1.3, 0.01))
                components.append(
                    f"  {key}: {{kind: {kind}, diameter: {part.diameter!r} m, weight: "
                    f"{part.weight!r} N/m, cn: {drags[0]}, ct: {drags[1]}, stiffness: "
                    f"{part.stiffness!r} N}}"
                )
                used.append(f"      - {{use: {key}, length: {part.length!r} m}}")
            return used

        components.append(
            f"  buoy: {{kind: body, length: 1 m, buoyancy: {self.lift!r} N, kn: {self.drag!r} "
            "N/(m/s)^2, inclination: insensitive}"
        )
        legs += ["  float:", "    line:", "      - {use: buoy}", *line("stem", (self.stem,))]
        legs += ["    top: free", "    bottom: {join: A}"]
        for number, (parts, (east, north)) in enumerate(self.legs):
            legs += [f"  a{number}:", "    line:", *line(f"a{number}", parts)]
            legs += ["      - {use: dw}", "    top: {join: A}"]
            legs += [f"    bottom: {{anchor: {{at: [{east!r} m, {north!r} m]}}}}"]
        components.append("  dw: {kind: anchor, weight: 1e7 N, length: 0 m}")
        rows = [f"      - [0, {self.top[0]!r}, {self.top[1]!r}]"]
        rows.append(f"      - [{self.depth!r}, {self.bottom[0]!r}, {self.bottom[1]!r}]")
        return "\n".join([
            "name: surface net", "environment:", f"  depth: {self.depth!r} m", "  current:",
            "    columns: [depth m, u m/s, v m/s]", "    rows:", *rows, "components:",
            *components, "legs:", *legs, "",
        ])  # fmt: skip


CHAINS = ((0.013, 32.1, 13.5e6), (0.019, 68.6, 28.9e6), (0.025, 118.8, 50e6))
"""Diameter [m], weight in water [N/m] and EA [N] of open link chain."""


def surface_net(number: int) -> SurfaceNet:
    """The net of a number."""
    rng = np.random.default_rng(number)

    def between(low: float, high: float) -> float:
        return float(np.round(rng.uniform(low, high), 4))

    depth = float(np.round(np.exp(rng.uniform(np.log(15.0), np.log(1200.0))), 1))
    count, turn, reach = int(rng.integers(2, 7)), between(0.0, 2.0 * pi), between(0.8, 3.0)
    stem = float(np.round(depth * rng.uniform(0.08, 0.18), 2))
    legs, weight = [], 60.0 * stem
    for number in range(count):
        angle = turn + 2.0 * pi * (number + rng.uniform(-0.2, 0.2)) / count
        away = depth * reach * rng.uniform(0.9, 1.1)
        whole = hypot(away, depth - stem) * rng.uniform(1.08, 1.3)
        share, size = rng.uniform(0.1, 0.55), between(0.012, 0.03)
        dense = between(300.0, 1200.0)  # of nylon to polyester: N/m in water per m² of the disc
        wire = Part(
            float(np.round((1.0 - share) * whole, 2)),
            float(np.round(dense * size * 2.0 * size, 4)), size,
            float(np.round(rng.uniform(2e8, 1.5e9) * size**2, 0)),
        )  # fmt: skip
        diameter, heavy, stiffness = CHAINS[int(rng.integers(3))]
        chain = Part(float(np.round(share * whole, 2)), heavy, diameter, stiffness, True)
        clump = [Part(0.0, between(20.0, 300.0))] if rng.random() < 0.5 else []
        at = float(np.round(away * cos(angle), 2)), float(np.round(away * sin(angle), 2))
        legs.append(((wire, *clump, chain), at))
        weight += wire.weight * wire.length + chain.weight * chain.length
    speed, toward = between(0.1, 0.8), between(0.0, 2.0 * pi)
    lower, way = speed * rng.uniform(0.1, 0.6), toward + rng.uniform(-1.0, 1.0)
    lift = float(np.round(weight * rng.uniform(0.7, 2.0), 1))
    return SurfaceNet(
        depth, (speed * cos(toward), speed * sin(toward)), (lower * cos(way), lower * sin(way)),
        lift, float(np.round(0.6 * lift ** (2.0 / 3.0), 1)),
        Part(stem, 60.0, 0.019, 30e6, True), tuple(legs),
    )  # fmt: skip
