"""Convert buoys, anchors, connectors and materials of WHOI Cable to components, with their drag."""

import math
from dataclasses import dataclass
from itertools import pairwise

from calm.errors import refused
from calm.exchange.cbl.grammar import CableDefinition, KeyValue, KeyValues
from calm.exchange.model import FigureOrWord, ImportedComponent, Remark
from calm.exchange.part_names import role_of
from calm.files.definition import CATALOGUE_DENSITY
from calm.units import KILOGRAM_FORCE

# a diameter is doubtful if its displacement exceeds the displacement from mass and weight by this
# factor, even for a cable with fairing
_TOO_WIDE = 20.0
_ROPE = 10.0  # m: a shorter segment may be a frame, whose diameter represents its drag
_FASTEST = 10.0  # m/s: a drag table beyond this range is a function of depth
_DYNAMICS = (
    "ei", "gj", "am", "amn", "amt", "can", "cat", "cmn", "cmt", "bn", "bt", "b", "cg", "cl",
    "i", "j", "g", "nu",
)  # fmt: skip
_STEPS = 12  # rows of a table between two diameters
_SLIGHT = 1e-9


@dataclass
class ComponentMaker:
    """Converter of the buoys, anchors, connectors and materials of a problem file to components.

    `density` [kg/m³] and `gravity` [m/s²] are from the problem file. Unsupported keys are added to
    `dropped`.
    """

    density: float
    gravity: float
    dropped: list[Remark]

    def material(
        self, definition: CableDefinition, length: float, depth: float, speed: float
    ) -> ImportedComponent:
        """Convert a material to a cable, with the drag at a given depth and speed.

        Parameters
        ----------
        length : length of the segment [m]
        depth, speed : depth [m] and speed [m/s] at which a variable drag is evaluated
        """
        values, name = definition.values, definition.name
        across, inside = values.number("d", "diam"), values.number("id")
        if across <= 0.0:
            raise definition.token.refuse(f"material `{name}` has no diameter")
        area, bore = math.pi / 4.0 * across**2, math.pi / 4.0 * inside**2
        mass = values.number("m", "mass")
        dry = values.number("w") or mass * self.gravity
        wet = values.number("wet") or dry - area * self.density * self.gravity
        if not mass and not dry and not values.number("wet"):
            raise definition.token.refuse(f"material `{name}` has neither `m` nor `wet`")
        figures: dict[str, FigureOrWord] = {
            "diameter": across,
            "cn": _drag(values.get("cdn"), depth, speed),
            "ct": _drag(values.get("cdt"), depth, speed),
        }
        weight, mass = self._at_reference(wet, mass)
        component = ImportedComponent.of_line(name, weight, figures)
        if mass:
            component.figures["mass"] = mass
        if (
            mass
            and length > _ROPE
            and _TOO_WIDE * (mass - weight / self.gravity) < CATALOGUE_DENSITY * area
        ):
            component.guesses["diameter"] = (
                "value of the file, which contradicts mass and weight: one metre of this diameter "
                f"displaces {CATALOGUE_DENSITY * area:.3g} kg of water, but a mass of {mass:.3g} "
                f"kg and a weight in water of {weight:.3g} N mean that one metre displaces only "
                f"{mass - weight / self.gravity:.3g} kg"
            )
        self._stretch(component, definition, area - bore)
        self._drop(definition)
        return component

    def _stretch(
        self, component: ImportedComponent, definition: CableDefinition, section: float
    ) -> None:
        values = definition.values
        stiffness = values.number("ea") or values.number("e") * section
        tension = values.get("t")
        if not stiffness and tension is not None:
            stiffness = tension.at(0.01) / 0.01
            component.guesses["stiffness"] = (
                "the file has a curve of tension against strain; the stiffness is the tension at a "
                "strain of 0.01, divided by 0.01"
            )
        if stiffness > 0.0:
            component.figures["stiffness"] = stiffness
        working, breaking = values.number("swl"), values.number("yield")
        if breaking > 0.0:
            component.figures["breaking_load"] = breaking
        if working > 0.0 and (not breaking or working <= breaking):
            component.figures["working_load"] = working

    def connector(self, definition: CableDefinition) -> ImportedComponent:
        """Convert a connector to a sphere with the same drag and length.

        A connector without a diameter becomes a body.
        """
        values, name = definition.values, definition.name
        wet, mass = self._at_reference(values.number("wet"), values.number("m", "mass"))
        across, drag = values.number("d", "diam"), values.number("cdn")
        figures: dict[str, FigureOrWord] = {"diameter": across} if across > 0.0 else {}
        figures |= {"length": values.number("length"), "buoyancy": 0.0 - wet}
        kind = "sphere" if across > 0.0 else "body"
        figures |= {"cx": drag} if across > 0.0 else {"drag_area": 0.0, "cd": drag}
        if mass:
            figures["mass"] = mass
        figures["role"] = role_of(name, -wet, fastener=abs(wet) < 20.0)
        self._drop(definition)
        return ImportedComponent(name, kind, figures)

    def anchor(
        self, definition: CableDefinition | None, name: str, friction: float
    ) -> ImportedComponent:
        """Convert an anchor; the component has no weight if the file gives none.

        `name` and `friction` are from the layout. A missing friction coefficient is 0.
        """
        values = definition.values if definition else KeyValues()
        figures: dict[str, FigureOrWord] = {}
        wet, mass = values.number("wet"), values.number("m", "mass")
        if wet > 0.0:
            figures["weight"], known = self._at_reference(wet, mass)
            if known:
                figures["mass"] = known
        elif mass > 0.0:
            figures["mass"] = mass
        mu = values.number("mu") or friction
        if mu > 0.0:
            figures["friction"] = mu
        component = ImportedComponent(name, "anchor", figures)
        if "mass" in figures and "weight" not in figures:
            component.guesses["mass"] = "the file gives no weight in water; steel is assumed"
        return component

    def buoy(self, definition: CableDefinition, *, afloat: bool) -> ImportedComponent:
        """Convert a buoy: the float of a mooring, or a towed body.

        A submerged buoy becomes a point, as in WHOI Cable; a buoy at the surface has a hull.
        """
        values, name = definition.values, definition.name
        shape = values["type"].text.lower() if "type" in values else "sphere"
        if shape in ("ship", "platform"):
            raise definition.token.refuse(
                f"`{name}` is a {shape}; in CALM a line ends at a float or at a towing ship"
            )
        hull = _displacement_table(definition, shape)
        height, volume, area = hull[-1]
        mass = values.number("m", "mass") or values.number("w") / self.gravity
        lift = values.number("buoyancy")
        whole = lift / (self.density * self.gravity) if lift else volume
        if not whole:
            raise refused(definition.token.path, f"buoy `{name}` has no size and no buoyancy")
        drag = values.number("cdn")
        across = values.number("d", "diam")
        figures: dict[str, FigureOrWord]
        if shape == "sphere":
            kind, figures = "sphere", {"diameter": across, "length": height, "cx": drag}
        elif shape == "cylinder" and afloat:
            kind = "cylinder"
            figures = {"diameter": across, "length": height, "cn": drag}
            figures["inclination"] = "insensitive"
        else:
            kind, figures = "body", {"length": height, "drag_area": area, "cd": drag}
        component = ImportedComponent(name, kind, figures)
        if not afloat:
            figures["length"] = 0.0
            component.comment = "The length is 0, because WHOI Cable treats this body as a point."
        elif kind == "body":
            component.hull = hull
        figures |= {"mass": mass, "volume": whole}
        windage, wind_drag = values.number("sw"), values.number("cdw") or drag
        if afloat and (windage or wind_drag):
            figures |= {"wind_area": windage} if windage else {}
            figures["wind_cd"] = wind_drag
        net = (self.density * whole - mass) * self.gravity
        figures["role"] = "float" if net > 0.0 else "instrument"
        self._drop(definition)
        return component

    def _at_reference(self, wet: float, mass: float) -> tuple[float, float]:
        """Convert a weight in the water of the file to reference water [N]; also return the mass.

        If the mass is missing, or is too small for the weight, the weight is not converted and a
        mass of 0 is returned.
        """
        if mass * KILOGRAM_FORCE < wet or mass <= 0.0:
            return wet, 0.0
        volume = (mass - wet / self.gravity) / self.density
        return wet + (self.density - CATALOGUE_DENSITY) * self.gravity * volume, mass

    def _drop(self, definition: CableDefinition) -> None:
        found = [key for key in _DYNAMICS if key in definition.values]
        what = ", ".join({"ei": "EI", "gj": "GJ"}.get(key, key) for key in found)
        remark = Remark(definition.name, f"properties that CALM does not use ({what})")
        if found and remark not in self.dropped:
            self.dropped.append(remark)


def counts_on_depth(value: KeyValue) -> bool:
    """True if a drag coefficient depends on depth rather than on speed.

    The first column of a table is read as speeds if its last value is a realistic speed.
    """
    return not value.rows or value.rows[-1][0].at() > _FASTEST


def _drag(value: KeyValue | None, depth: float, speed: float) -> float:
    return 0.0 if value is None else value.at(depth if counts_on_depth(value) else speed)


def varies(definition: CableDefinition) -> bool:
    """True if a drag coefficient of a material varies with depth."""
    given = [definition.values[key] for key in ("cdn", "cdt") if key in definition.values]
    deep = [value for value in given if counts_on_depth(value)]
    return any(value.rows or (value.formula and value.formula.names) for value in deep)


def _displacement_table(
    definition: CableDefinition, shape: str
) -> tuple[tuple[float, float, float], ...]:
    """Return rows of draft [m], displaced volume [m³] and immersed area [m²]."""
    values = definition.values
    across = values.number("d", "diam")
    height = values.number("h", "height")
    if shape == "axisymmetric":
        return _axisymmetric_table(definition)
    if across <= 0.0:
        raise definition.token.refuse(f"buoy `{definition.name}` has no diameter")
    if shape == "cylinder" and height <= 0.0:
        raise definition.token.refuse(f"buoy `{definition.name}` has no height `h`")
    if shape == "cylinder":
        return ((height, math.pi / 4.0 * across**2 * height, across * height),)
    if shape not in ("sphere", "capsule"):
        raise definition.token.refuse(f"buoy `{definition.name}` has an unknown type")
    radius, beside = across / 2.0, max(height - across, 0.0) if shape == "capsule" else 0.0
    rows = []
    for step in range(2 * _STEPS + 1):
        draft = across * step / (2 * _STEPS)
        angle = 2.0 * math.acos(max(-1.0, min(1.0, (radius - draft) / radius)))
        disc = 0.5 * radius**2 * (angle - math.sin(angle))
        rows.append(
            (draft, (1.5 * across - draft) * draft**2 * math.pi / 3.0 + disc * beside, disc)
        )
    return tuple(rows)


def _axisymmetric_table(definition: CableDefinition) -> tuple[tuple[float, float, float], ...]:
    value = definition.values.get("diameters")
    if value is None or len(value.rows) < 2 or any(len(row) != 2 for row in value.rows):
        raise definition.token.refuse(
            f"buoy `{definition.name}` needs `diameters` at two levels or more"
        )
    levels = [(row[0].at(), row[1].at()) for row in value.rows]
    if any(b[0] <= a[0] or a[1] < 0.0 for a, b in pairwise(levels)):
        raise value.token.refuse("the levels of `diameters` must increase")
    rows = [(0.0, 0.0, 0.0)]
    volume = area = 0.0
    keel = levels[0][0]
    for (low, narrow), (high, wide) in pairwise(levels):
        for step in range(1, _STEPS + 1):
            part = (high - low) * step / _STEPS
            across = narrow + (wide - narrow) * step / _STEPS
            cone = math.pi / 12.0 * part * (narrow**2 + narrow * across + across**2)
            shown = 0.5 * part * (narrow + across)
            rows.append((low - keel + part, volume + cone, area + shown))
        _, volume, area = rows[-1]
    return tuple(row for i, row in enumerate(rows) if i == 0 or row[1] > rows[i - 1][1] + _SLIGHT)
