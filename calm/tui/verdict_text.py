"""Text of the verdict: values and findings, or the missing parts of a line."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from calm.checks.finding import AS_GIVEN, OWN, Finding, Rule, State, grouped_by
from calm.quantities import say
from calm.tui.theme import ELLIPSIS
from calm.tui.workspace import mistakes, place_of

if TYPE_CHECKING:
    from calm.case import Result
    from calm.case.leg_result import LegResult
    from calm.checks.assessment import MooringInEnvironment
    from calm.files import Place
    from calm.tui.live import HeldLine, View

_MOST_PROBLEMS = 6


@dataclass(frozen=True)
class VerdictLine:
    """A line of the verdict.

    Attributes
    ----------
    state : state that determines the symbol and the colour, or None
    faint : whether the text is dimmed
    pending : whether the state may still change
    places : rows that the text concerns
    """

    text: str
    heading: str = ""
    state: State | None = None
    faint: bool = False
    pending: bool = False
    places: tuple[Place, ...] = ()

    @property
    def sign(self) -> str:
        """Symbol in front of the line."""
        if self.pending:
            return ELLIPSIS
        return " " if self.state is None else self.state.sign


def headline(view: View | None) -> VerdictLine:
    """Return the verdict in a few words, as a line."""
    if view is None:
        return VerdictLine(ELLIPSIS, faint=True)
    if view.problems:
        return VerdictLine(mistakes(view.problems, view.path), state=State.FAIL)
    if view.missing:
        return VerdictLine(f"incomplete: {view.missing[0]}", state=State.UNKNOWN)
    if view.failure is not None:
        return VerdictLine(f"no equilibrium: {view.failure.status}", state=State.FAIL)
    if view.elsewhere:
        return VerdictLine("invalid environments", state=State.FAIL)
    verdict = _judged((*view.findings, *view.tighter), view)
    if view.complete:
        return verdict
    outcome = verdict.text if verdict.state in (State.FAIL, State.WARN) else "nothing fails"
    return VerdictLine(f"{outcome} so far", pending=True)


def _judged(findings: Sequence[Finding], view: View) -> VerdictLine:
    from calm.files.pieces import parts_of
    from calm.report.open_items import verdict_of

    if not findings:
        return VerdictLine("solved")
    pieces = () if view.file is None else view.file.pieces
    verdict = verdict_of(findings, {part.label: part.use for part in parts_of(pieces)})
    return VerdictLine(verdict.text, state=verdict.state)


def verdict_lines(view: View | None) -> Iterator[VerdictLine]:
    """Yield all lines of the verdict below its headline, the most severe first."""
    if view is None:
        return
    if view.problems:
        for problem in view.problems[:_MOST_PROBLEMS]:
            yield VerdictLine(problem.message, place_of(problem, view.path), State.FAIL)
        if (more := len(view.problems) - _MOST_PROBLEMS) > 0:
            yield VerdictLine(f"and {more} more", faint=True)
        yield VerdictLine("t shows the text with its mistakes", faint=True)
        return
    for text in view.missing:
        yield VerdictLine(text, heading="Missing", state=State.UNKNOWN)
    if view.failure is not None:
        yield VerdictLine(view.failure.message, state=State.FAIL)
        yield VerdictLine(view.failure.advice, faint=True)
    findings = [_with_environment(each, view) for each in view.findings]
    tighter = [_with_environment(each, view) for each in view.tighter]
    yield from _values_at_ends(view, [*findings, *tighter], pending=not view.complete)
    for problem in view.elsewhere:
        yield VerdictLine(problem.message, place_of(problem, view.path), State.FAIL)
    if len(view.cases) > 1:
        yield from (_environment_line(case, view) for case in view.cases)
    yield from _finding_lines(findings, tighter, pending=not view.complete)
    if view.result is not None:
        for text in view.result.warnings:
            yield VerdictLine(text, state=State.WARN)


def _with_environment(finding: Finding, view: View) -> Finding:
    if finding.environment == view.here:
        return finding
    there = _environment(finding.environment)
    given = finding.situation == AS_GIVEN
    return replace(finding, situation=there if given else f"{there}, {finding.situation}")


def _environment(name: str) -> str:
    return "default environment" if name == OWN else name


def _environment_line(case: MooringInEnvironment, view: View) -> VerdictLine:
    verdict = _judged((*case.findings, *case.tighter, *case.lacking), view)
    result = case.result
    figures = ""
    if result is not None and result.type != "surface":
        figures = f"top at {say('depth', result.top.depth)}, "
    elif result is not None:
        figures = f"{say('reserve', result.top.reserve)} in reserve, "
    return VerdictLine(
        f"{figures}{verdict.text}", f"In {_environment(case.environment)}", verdict.state
    )


def _values_at_ends(
    view: View, findings: Sequence[Finding], *, pending: bool
) -> Iterator[VerdictLine]:
    result = view.result
    if result is None:
        return
    if result.several:
        yield from _values_of_net(result)
    elif not result.towed:
        yield from _values_of_mooring(result.leg, findings, pending, view.held)
    else:
        point, body = result.tow_point, result.body
        pull = f"{say('tension', point.tension)}, {say('angle', point.angle)} below the horizontal"
        yield VerdictLine(pull, "Tow point")
        behind = f"{say('depth', body.depth)} deep, {say('layback', body.layback)} behind"
        yield VerdictLine(behind, "Body")


def _values_of_mooring(
    result: LegResult, findings: Sequence[Finding], pending: bool, held: Sequence[HeldLine]
) -> Iterator[VerdictLine]:
    """Yield values at the anchor and the top of the mooring, in the situation as given.

    If a value with a limit is worse in another situation, the worst value follows.
    """
    from calm.checks.posture import knockdown, reserve
    from calm.checks.strength import anchor_weight

    anchor, top = result.anchor_load, result.top
    pull = f"{say('tension', anchor.tension)}, {say('angle', anchor.angle)} off the vertical"
    yield VerdictLine(pull, heading="Anchor")
    yield _anchor_weight_line(result, _worst(findings, anchor_weight), pending, held)
    if result.type == "surface":
        used = f"{top.used_buoyancy:.0%} of the float's buoyancy in use"
        worst = _worst(findings, reserve)
        if worst is not None and worst.value is not None:
            used += _at_worst(worst, f"{1.0 - worst.value:.0%}")
        text = f"{say('reserve', top.reserve)}; {used}"
        yield _value_line(text, "Reserve", worst)
    else:
        depth = f"top at {say('depth', top.depth)}"
        worst = _worst(findings, knockdown)
        if worst is not None:
            depth += _at_worst(worst, say("knockdown", worst.value))
        text = f"{say('knockdown', top.knockdown)}, {depth}"
        yield _value_line(text, "Knockdown", worst)
    if anchor.grounded_length > 0.0:
        yield VerdictLine(
            f"{say('grounded_length', anchor.grounded_length)} of line", heading="On seabed"
        )


def _anchor_weight_line(
    result: LegResult, worst: Finding | None, pending: bool, held: Sequence[HeldLine]
) -> VerdictLine:
    """Return the verdict line on the required and the actual anchor weight.

    Without an anchor, the line gives only the required weight. The required weight is the maximum
    over all situations, once the situations are solved.
    """
    if worst is None:
        needed, when = result.anchor_load.required_weight, ""
        if held:
            needed, when = max((one.needed(result.file.anchor), one.when) for one in held)
        situation = f" ({when})" if when else ""
        return VerdictLine(f"needs {say('required_weight', needed)}{situation} in water")
    needs = f"needs {say('required_weight', worst.limit)}{_situation(worst)}"
    has = f"has {say('required_weight', worst.value)} in water"
    unsure = pending and worst.state is State.PASS
    return VerdictLine(
        f"{needs}, {has}", state=worst.state, pending=unsure, places=_places([worst])
    )


def _worst(findings: Sequence[Finding], rule: Rule) -> Finding | None:
    own = [each for each in findings if each.rule == rule.name]
    return min(own, key=lambda each: each.rank, default=None)


def _at_worst(worst: Finding, figure: str) -> str:
    return "" if worst.situation == AS_GIVEN else f"; {figure} at worst{_situation(worst)}"


def _situation(finding: Finding) -> str:
    return "" if finding.situation == AS_GIVEN else f" ({finding.situation})"


def _value_line(text: str, heading: str, worst: Finding | None) -> VerdictLine:
    state = worst.state if worst is not None and _graver(worst) else None
    return VerdictLine(text, heading, state, places=_places([worst]))


def _values_of_net(result: Result) -> Iterator[VerdictLine]:
    for end in (*result.anchors, *result.held):
        needs = end.required_weight
        needed = "" if needs is None else f", needs {say('required_weight', needs)} in water"
        heading = f"{'Held end' if needs is None else 'Anchor'} of {end.leg}"
        yield VerdictLine(f"{say('tension', end.tension)}{needed}", heading)
    for node in result.nodes:
        yield VerdictLine(f"{say('depth', node.depth)} deep", f"Node {node.name}")


def _finding_lines(
    findings: Sequence[Finding], tighter: Sequence[Finding], *, pending: bool
) -> Iterator[VerdictLine]:
    """Yield failures and warnings with reason and remedy, then summaries of unknowns and passes.

    A rule is listed as passed if every component passes.
    """
    from calm.checks.finding import governing
    from calm.report.check_tables import named, named_components

    governs = {(one.rule, one.place, one.state): one for one in (*findings, *tighter)}
    listed = dict.fromkeys(governs[one.rule, one.place, one.state] for one in findings)
    for finding in sorted(listed, key=lambda each: each.rank):
        if _graver(finding):
            yield _finding_line(finding)
    unknown = [each for each in findings if each.state is State.UNKNOWN]
    for one in unknown:
        if (figure := one.missing) is not None:
            needed = ", ".join(figure.needed_by)
            text = f"{figure.quantity} of {named(figure.pieces)}, needed by {needed}"
            heading = f"Missing value of {figure.component_id}"
            yield VerdictLine(text, heading, State.UNKNOWN, places=_places([one]))
    for own in grouped_by((each for each in unknown if each.missing is None), _title).values():
        text = f"unknown for {named_components(own)}"
        yield VerdictLine(text, _title(own[0]), State.UNKNOWN, places=_places(own))
    met = (State.PASS, State.NOT_JUDGED)
    other = {_title(each) for each in findings if each.state not in met}
    for state, heading in (
        (State.ACCEPTED, "Accepted"),
        (State.ESTIMATED, "Estimated"),
        (State.PASS, "Pass so far" if pending else "Pass"),
    ):
        those = [one for one in (*findings, *tighter) if one.state is state]
        passes = state is State.PASS
        rules = [
            each
            for each in grouped_by(those, _title).values()
            if not passes or _title(each[0]) not in other
        ]
        if rules:
            leads = sorted(map(governing, rules), key=lambda one: -(one.utilisation or 0.0))
            text = ", ".join(map(_used, leads))
            yield VerdictLine(text, heading, state, pending=pending and passes)


def _used(finding: Finding) -> str:
    from calm.report.open_items import percent_text

    used = finding.utilisation
    return _title(finding) if used is None else f"{_title(finding)} {percent_text(used)} %"


def why(view: View, row: Place) -> list[VerdictLine]:
    """Return all findings on a row with their remedies, the most severe first."""
    found = [_with_environment(each, view) for each in (*view.findings, *view.tighter)]
    own = [each for each in found if row in _places([each])]
    return [_finding_line(each) for each in sorted(own, key=lambda each: each.rank)]


def _finding_line(finding: Finding) -> VerdictLine:
    from calm.checks.assess import RULES
    from calm.checks.finding import no_capacity
    from calm.report.open_items import percent_text

    text = f"{finding.message} {finding.remedy or ''}".rstrip()
    if finding.utilisation is not None:
        sign = "≤" if finding.sense == "<=" else "≥"
        of = f" of {sign} {say(RULES[finding.rule].quantity, finding.limit)}"
        of = "; no capacity is left" if no_capacity(finding) else of
        text = f"{percent_text(finding.utilisation)} %{of}. {text}"
    heading = f"{_title(finding)}{_situation(finding)}"
    return VerdictLine(text, heading, finding.state, places=_places([finding]))


def _places(findings: Iterable[Finding | None]) -> tuple[Place, ...]:
    found = (place.row for each in findings if each is not None for place in each.places)
    return tuple(dict.fromkeys(found))


def _graver(finding: Finding) -> bool:
    return finding.state in (State.FAIL, State.WARN)


def _title(finding: Finding) -> str:
    from calm.checks.assess import RULES

    rule = RULES.get(finding.rule)
    return rule.title if rule else finding.rule
