"""The design check: each leg in each environment, then launch, recovery, breaks and composition.

For a net of legs, waves, launch and recovery are not checked.
"""

from collections.abc import Sequence
from dataclasses import replace
from datetime import date

import numpy as np

from calm.case.design import Design
from calm.case.leg import Leg
from calm.checks import assess, assessment, situations
from calm.checks.arrangement import clamp_place, hardware, metals, release_present, swivel
from calm.checks.assessment import (
    Assessment,
    Handling,
    MooringInEnvironment,
    Situation,
    estimated,
)
from calm.checks.catalogue_rules import figures
from calm.checks.criterion import limits_used
from calm.checks.finding import AS_GIVEN, OWN
from calm.checks.handling import backup
from calm.checks.inventory import inventory_of
from calm.checks.joints import joints
from calm.checks.leg_graph import LegGraph
from calm.checks.missing import with_missing
from calm.checks.planned import planned_depth, planned_parts
from calm.checks.serials_and_dates import serials_and_dates
from calm.errors import NoEquilibrium
from calm.files.legs import stand_in_anchor
from calm.files.mooring_file import refuse_tow
from calm.files.pieces import STAND_IN
from calm.solve import Status, expect_many

NOT_HANDLED = (
    "a net of legs: each leg is checked by the rules for a single line; launch, recovery and "
    "waves are not checked"
)
_NOT_SOLVED = Status.NOT_CONVERGED.because("The launch and the recovery of a net are not computed.")


def check(*designs: Design, day: date | None = None) -> Assessment:
    """Check a mooring or a net of legs against all rules of the design check.

    Parameters
    ----------
    designs : the design in each of its environments
    day : date on which acceptances must be valid; today by default

    Raises
    ------
    UsageError
        The design is a tow.
    """
    for each in designs:
        refuse_tow(each.file)
    name = designs[0].file.name
    expect_many(situations.SOLVES * len(designs))
    in_environments = [
        checked for each in designs for checked in environments_checked(each, name, day)
    ]
    return assessment_of(name, in_environments, day)


def environments_checked(
    design: Design, name: str, day: date | None = None
) -> list[MooringInEnvironment]:
    """Apply the rules to each leg of a design, in all situations of its environment.

    The result has one entry per leg, or a single entry without an equilibrium.

    Parameters
    ----------
    name : name in the findings
    day : date on which acceptances must be valid; today by default
    """
    environment = design.environment.name or OWN
    given, *changed = situations.situations_of(design)
    if given[0].failure is not None:
        return [failed_environment(design, name, given[0].failure)]
    return [
        assess.checked_environment(
            # a failure of a net is the failure of each leg
            (given[number], *(each[number if len(each) > 1 else 0] for each in changed)),
            leg,
            name,
            f"{environment}: {leg.name}" if design.several else environment,
            day,
        )
        for number, leg in enumerate(design.legs)
    ]


def failed_environment(design: Design, name: str, failure: NoEquilibrium) -> MooringInEnvironment:
    """Return the entry of `environments_checked` for a design that could not be solved."""
    environment, situation = design.environment.name or OWN, Situation(AS_GIVEN, None, failure)
    return assess.checked_environment((situation,), design.legs[0], name, environment)


def assessment_of(
    name: str, in_environments: Sequence[MooringInEnvironment], day: date | None = None
) -> Assessment:
    """Check composition, breaks, launch and recovery of a design, and build its assessment.

    Parameters
    ----------
    in_environments : entries of `environments_checked` for all environments, in order
    day : date on which acceptances must be valid; today by default
    """
    if not in_environments[0].leg.of_several:
        return assess.assessment_of(name, in_environments, day)
    in_environments = assess.with_cases(in_environments)
    own: dict[str, MooringInEnvironment] = {}
    for checked in in_environments:
        if checked.result is not None:
            own.setdefault(checked.leg.name, checked)
    found = [checked.result for checked in own.values() if checked.result is not None]
    legs = [each.leg for each in found] or [in_environments[0].leg]
    whole = _joined_legs(legs, any(each.type == "surface" for each in found))
    acceptance = assessment.Acceptance.of_file(whole.file, day)
    graph = LegGraph.in_equilibrium(found)
    breaks, losses = graph.breaks(whole), graph.losses(whole)
    handling = Handling(estimated(whole), _NOT_SOLVED, _NOT_SOLVED, breaks, losses)
    first = whole.file.environment.name or OWN
    once = [(each, each.judge(handling), first) for each in (hardware, figures, serials_and_dates)]
    if graph.anchored:
        once.append((release_present, graph.release_verdicts(), first))
        once.append((backup, backup.judge(handling), first))
    for checked in own.values():
        alone = Handling(estimated(checked.leg), _NOT_SOLVED, _NOT_SOLVED, ())
        once += [(each, each.judge(alone), checked.environment)
                 for each in (joints, swivel, clamp_place, metals)]  # fmt: skip
    for result in [each for each in found if planned_parts(each)] or found[:1]:
        alone = Handling(estimated(result.leg), _NOT_SOLVED, _NOT_SOLVED, (), result=result)
        once.append((planned_depth, planned_depth.judge(alone), first))
    waters = {checked.leg.file.environment.name: checked.leg for checked in in_environments}
    findings = list(assess.findings_of_currents(list(waters.values()), name, acceptance))
    findings += assess.findings_of_drag(found, name, acceptance)
    for rule, verdicts, environment in once:
        findings += acceptance.findings(rule, verdicts, name, environment)
    findings = assess.cased(findings, in_environments)
    lacking = [one for checked in in_environments for one in checked.lacking]
    findings = with_missing((*lacking, *findings), acceptance.parts, name, first)
    fast = (float(np.hypot(each.water.u, each.water.v).max()) for each in waters.values())
    if found and max(fast) < situations.LEAST_CURRENT:
        still = situations.equilibrium.find(situations.STILL_ONLY, name, first)
        findings.insert(0, still.but(case=situations.case_of(1, AS_GIVEN)))
    surface = bool(whole.for_surface)
    accepted = [
        *(one for checked in in_environments for one in checked.accepted),
        *findings,
    ]
    return Assessment(
        name=name,
        in_environments=tuple(in_environments),
        launch=None,
        recovery=None,
        backup=breaks,
        losses=losses,
        limits=tuple(dict.fromkeys(k for each in legs for k in limits_used(each.file, surface))),
        inventory=tuple(item for item in inventory_of(whole) if item.use != STAND_IN),
        findings=tuple(findings),
        notices=(NOT_HANDLED, *acceptance.notices(accepted)),
    )


def _joined_legs(legs: Sequence[Leg], surface: bool) -> Leg:
    pieces = [piece for leg in legs for piece in leg.pieces]
    pieces.append(stand_in_anchor(0, len(pieces)))
    listed = tuple(replace(piece, index=index) for index, piece in enumerate(pieces))
    file = replace(legs[0].file, pieces=listed, legs=())
    return Leg(file, surface, given_water=legs[0].water)
