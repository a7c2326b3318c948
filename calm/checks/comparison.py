"""Comparison of two designs: depths, knockdown, tensions, margins, anchor and weights."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import hypot, isfinite
from typing import Any

from calm.case.design import Design, Result
from calm.case.leg_result import LegResult
from calm.case.result_tables import ComponentRow, rows_by_place
from calm.checks.assess import RULES
from calm.checks.assessment import Assessment
from calm.checks.design_check import check
from calm.checks.finding import State, by_rule, governing, worst_state
from calm.checks.inventory import total_of
from calm.errors import NoEquilibrium, or_why_not
from calm.files import Flexible
from calm.files.file_differences import Change, Differences, differences
from calm.quantities import QUANTITIES

Number = float | None


@dataclass(frozen=True)
class Compared:
    """Values of one quantity in two designs.

    Attributes
    ----------
    name : dotted name of the quantity, such as ``top.depth``
    quantity : name in `calm.quantities`; "" for a text
    before, after : values in SI units or degrees, or texts
    states : states of the rule in both designs, for a margin or utilisation
    of_a_part : whether the value belongs to a piece or clamp
    """

    name: str
    title: str
    quantity: str
    before: Number | str
    after: Number | str
    states: tuple[State, State] | None = None
    of_a_part: bool = False


@dataclass(frozen=True)
class Comparison:
    """Comparison of two designs, or of a design with its deployment.

    Attributes
    ----------
    differences : differences between the two files
    figures : computed values of both designs
    notes : reasons why values are missing
    """

    names: tuple[str, str]
    differences: Differences
    figures: tuple[Compared, ...]
    notes: tuple[str, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """Return the comparison as a JSON object; unknown values are None."""
        found = self.differences
        return {
            "names": list(self.names),
            "changed": [_change(one) for one in found.changed],
            "moved": [_change(one) for one in found.moved],
            "added": list(found.added),
            "removed": list(found.removed),
            "figures": [
                {"name": one.name, "from": _finite(one.before), "to": _finite(one.after)}
                | ({} if one.states is None else {"states": list(one.states)})
                for one in self.figures
            ],
        }


_Solved = tuple[Result | NoEquilibrium, Assessment | None]
"""Result of a design, or the reason why there is none, and the assessment (None for a tow)."""
_Figures = dict[str, tuple[str, str, Number | str]]
"""Compared values of one design: title, quantity and value, by dotted name."""


def comparison_of(names: tuple[str, str], before: Design, after: Design) -> Comparison:
    """Solve, assess and compare two moorings, nets or tows.

    A design without an equilibrium is compared as far as possible. `names` are the names of the two
    designs.
    """
    found = differences(before.file, after.file)
    designs = _solved(before), _solved(after)
    sides = [_figures_of(each) for each in designs]
    figures = [
        Compared(name, title, quantity, sides[0].get(name, _NONE)[2], sides[1].get(name, _NONE)[2])
        for name, (title, quantity, _) in (sides[0] | sides[1]).items()
    ]
    notes = (
        f"{name}: {result}"
        for name, (result, _) in zip(names, designs, strict=True)
        if isinstance(result, NoEquilibrium)
    )
    return Comparison(
        names, found, (*figures, *_parts(found, designs), *_margins(designs)), tuple(notes)
    )


_NONE = "", "", None


def _solved(design: Design) -> _Solved:
    return or_why_not(design.solve), None if design.towed else check(design)


def _figures_of(design: _Solved) -> _Figures:
    result, assessment = design
    solved = not isinstance(result, NoEquilibrium)
    found: _Figures = {"status": ("status", "", "solved" if solved else "has no equilibrium")}
    if not isinstance(result, NoEquilibrium):
        found |= _figures_of_legs(result) if result.several else _figures_of_leg(result.leg)
        greatest = max(row.tension for row in result.components)
        factors = [row.safety_factor for row in result.components]
        least = min((factor for factor in factors if factor == factor), default=None)
        found["greatest_tension"] = ("maximum tension", "tension", greatest)
        found["least_safety_factor"] = ("minimum safety factor", "safety_factor", least)
    if assessment is not None:
        total = total_of(assessment.inventory)
        found |= {
            "mass_in_air": ("known mass in air", "dry_mass", total.dry_mass),
            "weight_in_water": ("weight in water", "wet_weight", total.wet_weight),
        }
    return found


def _figures_of_leg(result: LegResult) -> _Figures:
    point, body = result.tow_point, result.body
    if point is not None and body is not None:
        return {
            "body.depth": ("depth of the body", "depth", body.depth),
            "body.layback": ("layback of the body", "layback", body.layback),
            "body.tension": ("tension at the body", "tension", body.tension),
            "tow_point.tension": ("tension at the tow point", "tension", point.tension),
        }
    top, anchor = result.top, result.anchor_load
    found: _Figures = {
        "top.depth": ("depth of the top", "depth", top.depth),
        "top.knockdown": ("knockdown of the top", "knockdown", top.knockdown),
        "top.excursion": ("excursion of the top", "offset", hypot(top.x, top.y)),
        "top.reserve": ("reserve buoyancy", "reserve", top.reserve),
        "anchor.tension": ("anchor load", "tension", anchor.tension),
        "anchor.vertical": ("anchor load, vertical", "vertical", anchor.vertical),
        "anchor.horizontal": ("anchor load, horizontal", "horizontal", anchor.horizontal),
        "anchor.required_weight": (
            "anchor weight required", "required_weight", anchor.required_weight,
        ),
        "anchor.weight": ("anchor weight in water", "required_weight", anchor.weight),
    }  # fmt: skip
    if result.type != "surface":
        del found["top.reserve"]
    return found


def _figures_of_legs(result: Result) -> _Figures:
    found: _Figures = {}
    for node in result.nodes:
        found[f"{node.name}.depth"] = (f"depth of node {node.name}", "depth", node.depth)
    for leg in result.legs:
        if leg.leg.top.free:
            found[f"{leg.name}.top.depth"] = (f"top of leg {leg.name}", "depth", leg.top.depth)
    for end in (*result.anchors, *result.held):
        what = "anchor" if end in result.anchors else "held end"
        name, of = f"{end.leg}.{what.replace(' ', '_')}", f"of leg {end.leg}"
        found[f"{name}.tension"] = (f"load on the {what} {of}", "tension", end.tension)
        if end.required_weight is not None:
            needed = (f"anchor weight required {of}", "required_weight", end.required_weight)
            found[f"{name}.required_weight"] = needed
    return found


def _parts(found: Differences, designs: tuple[_Solved, _Solved]) -> Iterator[Compared]:
    first, second = (
        {} if isinstance(each, NoEquilibrium) else rows_by_place(each) for each, _ in designs
    )
    for before, after in found.pairs:
        if before.place not in first or after.place not in second:
            continue
        rows, label = (first[before.place], second[after.place]), before.label
        sides: dict[str, list[float]] = {}
        if before.component.role == "instrument":
            sides["depth"] = [row.upper[0] for row in rows]
            sides["tilt"] = [row.tilt for row in rows]
        if isinstance(before.component, Flexible):
            sides["cut_length"] = [row.cut_length for row in rows if isinstance(row, ComponentRow)]
        for name, values in sides.items():
            title = f"{QUANTITIES[name].heading} of {label}"
            before_it, after_it = values
            yield Compared(f"{label}.{name}", title, name, before_it, after_it, of_a_part=True)


def _margins(designs: tuple[_Solved, _Solved]) -> Iterator[Compared]:
    judged = [assessment for _, assessment in designs if assessment is not None]
    if len(judged) < 2:
        return
    found = [by_rule(assessment.every_finding()) for assessment in judged]
    for rule in RULES.values():
        sides = [each.get(rule.name, ()) for each in found]
        states = [worst_state(one.state for one in each) for each in sides]
        if not {one.state for each in sides for one in each} - {State.NOT_JUDGED}:
            continue
        leads = [governing(each) if each else None for each in sides]
        if any(one is not None and one.utilisation is not None for one in leads):
            before, after = (None if one is None else one.utilisation for one in leads)
            what, quantity = "utilisation", "utilisation"
        else:
            before, after = (None if one is None else one.margin for one in leads)
            what, quantity = "margin", rule.quantity
        name, title = f"{what}.{rule.name}", f"{what}: {rule.title}"
        yield Compared(name, title, quantity, before, after, (states[0], states[1]))


def _finite(value: Number | str) -> Number | str:
    return None if isinstance(value, float) and not isfinite(value) else value


def _change(change: Change) -> dict[str, Any]:
    return {"where": change.where, "from": change.before.value, "to": change.after.value}
