"""Nets drawn at random, as files: surface buoys on several legs, and floats below the surface.

Those below the surface stand in 60 to 3000 m of water of two to six levels, on one or two anchors,
some with chain that lies on the seabed. From their node hang a weight or nothing, and to it or to a
second node above it come one to three floats, each on its own line of one or two cables with an
instrument between.
"""

from __future__ import annotations

from math import cos, exp, log, pi, sin
from random import Random

from tests.validation.surface_nets import surface_net


def net_text(random: Random) -> str:
    """The file of a net."""
    if random.random() < 0.5:
        return surface_net(random.getrandbits(32)).text
    return _below_the_surface(random)


def _below_the_surface(random: Random) -> str:
    depth = exp(random.uniform(log(60.0), log(3000.0)))
    parts = _Parts(random)
    stem = random.uniform(0.2, 0.5) * depth
    floats = [random.uniform(0.05, 0.2) * depth for _ in range(random.randint(1, 3))]
    branches = len(floats) > 1 and random.random() < 0.5
    legs, lift = [], 0.0
    for number, length in enumerate(floats):
        line = parts.cables(length)
        buoyancy = random.uniform(1.0, 3.0) * (0.5 * parts.weight + 800.0)
        lift += buoyancy
        end = "B" if branches and number > 0 else "A"
        legs.append((f"float{number}", [parts.sphere(buoyancy), *line], "free", f"{{join: {end}}}"))
    if branches:
        legs.append(("between", parts.cables(0.05 * depth), "{join: B}", "{join: A}"))
    if random.random() < 0.5:
        hung = [*parts.cables(random.uniform(0.02, 0.1) * depth), parts.clump(0.1 * lift)]
        legs.append(("weight", hung, "{join: A}", "free"))
    for number in range(random.randint(1, 2)):
        away = 0.0 if number == 0 else random.uniform(0.2, 0.8) * stem
        line = parts.cables((stem**2 + away**2) ** 0.5 * random.uniform(1.0, 1.1))
        if random.random() < 0.5:
            line.append(parts.chain(random.uniform(0.02, 0.3) * stem))
        angle = random.uniform(0.0, 2.0 * pi)
        at = f"[{away * cos(angle)!r} m, {away * sin(angle)!r} m]"
        legs.append(
            (f"leg{number}", [*line, "{use: dw}"], "{join: A}", f"{{anchor: {{at: {at}}}}}")
        )
    return _file(depth, _current(random, depth), parts.components, legs)


class _Parts:
    """Components as they are drawn; `weight` is that of all so far in water [N]."""

    def __init__(self, random: Random) -> None:
        self.random, self.weight = random, 0.0
        self.components = ["dw: {kind: anchor, weight: 1e7 N, length: 0 m}"]

    def sphere(self, buoyancy: float) -> str:
        diameter = (6.0 * buoyancy / (0.6 * 1025.0 * 9.81) / pi) ** (1.0 / 3.0)
        return self._used(f"kind: sphere, diameter: {diameter!r} m, buoyancy: {buoyancy!r} N")

    def clump(self, weight: float) -> str:
        self.weight += weight
        return self._used(f"kind: body, length: 0 m, buoyancy: {-weight!r} N, kn: 5 N/(m/s)^2, "
                          "inclination: insensitive")  # fmt: skip

    def chain(self, length: float) -> str:
        self.weight += 33.0 * length
        return self._used("kind: chain, diameter: 13 mm, weight: 33 N/m, stiffness: 20 MN", length)

    def cables(self, length: float) -> list[str]:
        """One cable, or two with an instrument between."""
        if self.random.random() < 0.5:
            return [self._cable(length)]
        share = self.random.uniform(0.2, 0.8)
        weight = self.random.uniform(20.0, 200.0)
        self.weight += weight
        body = f"kind: cylinder, length: 1.2 m, diameter: 0.2 m, buoyancy: {-weight!r} N"
        meter = self._used(f"{body}, cn: 1.2, ct: 0.1")
        return [self._cable(share * length), meter, self._cable((1.0 - share) * length)]

    def _cable(self, length: float) -> str:
        diameter = self.random.uniform(0.006, 0.016)
        weight = self.random.uniform(0.2, 3.0)
        self.weight += weight * length
        stiffness = self.random.choice([2e9, 5e10]) * diameter**2
        return self._used(
            f"kind: cable, diameter: {diameter!r} m, weight: {weight!r} N/m, cn: 1.3, ct: 0.01, "
            f"stiffness: {stiffness!r} N", length,
        )  # fmt: skip

    def _used(self, text: str, length: float | None = None) -> str:
        name = f"c{len(self.components)}"
        self.components.append(f"{name}: {{{text}}}")
        return f"{{use: {name}}}" if length is None else f"{{use: {name}, length: {length!r} m}}"


def _current(random: Random, depth: float) -> list[str]:
    """Rows of depth, u and v, of a current that slows down and turns with depth."""
    count, speed = random.randint(2, 6), random.uniform(0.1, 0.9)
    toward, turn = random.uniform(0.0, 2.0 * pi), random.choice([0.0, 0.5, 2.0])
    rows = []
    for k in range(count):
        share = k / (count - 1)
        here = speed * exp(-random.choice([0.5, 2.0]) * share) * random.uniform(0.7, 1.0)
        angle = toward + turn * share * random.uniform(-1.0, 1.0)
        rows.append(f"[{share * depth!r}, {here * cos(angle)!r}, {here * sin(angle)!r}]")
    return rows


def _file(
    depth: float, current: list[str], components: list[str],
    legs: list[tuple[str, list[str], str, str]],
) -> str:  # fmt: skip
    lines = [
        "name: random net", "environment:", f"  depth: {depth!r} m", "  current:",
        "    columns: [depth m, u m/s, v m/s]", f"    rows: [{', '.join(current)}]",
        "components:", *(f"  {component}" for component in components), "legs:",
    ]  # fmt: skip
    for name, line, top, bottom in legs:
        lines += [f"  {name}:", "    line:", *(f"      - {part}" for part in line)]
        lines += [f"    top: {top}", f"    bottom: {bottom}"]
    return "\n".join([*lines, ""])
