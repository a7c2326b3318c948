"""What is judged profile by profile is what the design check judges of one."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import calm
from calm.batch.statistics.limits import NOT_JUDGED, limits_of
from calm.batch.statistics.series import ResultColumns
from calm.case import Design
from calm.checks.assess import RULES, STANDING
from calm.checks.assessment import Acceptance, estimated_result
from calm.checks.finding import State
from calm.checks.posture import reaches_the_surface
from calm.files.check_limits import Checks, MinimumTensions
from calm.shipped import shipped_folder
from tests.unit.batch.made_result import make_result, one_profile

LINES = sorted(shipped_folder("lines").glob("*.yaml"))
MOORINGS = [path for path in LINES if "\ntow:" not in path.read_text(encoding="utf-8")]
STRICT = Checks.model_construct(
    anchor_factor=60.0,
    minimum_tension=MinimumTensions.model_construct(wire=1e6, rope=1e6),
    minimum_reserve=0.99,
    rating_margin=1e5,
    maximum_knockdown=1e-3,
    maximum_excursion=1e-3,
    maximum_tilt=1e-2,
)


def judged_here(mooring, result):
    """By rule and component: the gravest state, its value and its limit."""
    found = {}
    with ResultColumns(one_profile(result)) as series:
        for limit in limits_of(mooring):
            key = (limit.rule.name, limit.criterion.part.label)
            if limit.criterion.limit is None:
                found[key] = State.UNKNOWN, None, None
                continue
            value = limit.values(series)
            if np.isnan(value).any():
                found.setdefault(key, (State.UNKNOWN, None, None))
                continue
            state = State.ESTIMATED if limit.on_estimate else State.PASS
            if limit.broken(value)[0]:
                state = State.UNKNOWN if limit.on_estimate else limit.criterion.beyond
            most = float(value[0]), limit.criterion.limit
            before = found.get(key, (State.PASS, None, None))
            alike = before[1] is not None and state is before[0] and not limit.criterion.least
            tighter = alike and most[0] * before[2] > before[1] * most[1]  # of two criteria
            if before[1] is None or state.severity > before[0].severity or tighter:
                found[key] = state, *most
    return found


def judged_there(result):
    acceptance = Acceptance.of_file(replace(result.file, accepts=()), None)
    return {
        (rule.name, one.component): (one.state, one.value, one.limit)
        for rule in STANDING
        if rule.name not in NOT_JUDGED
        for one in acceptance.findings(rule, rule.judge(estimated_result(result.leg)), "m", "own")
    }


@pytest.mark.parametrize("path", MOORINGS, ids=lambda path: path.stem)
@pytest.mark.parametrize("checks", [None, STRICT], ids=["own limits", "limits beyond reach"])
def test_one_profile_is_judged_as_by_the_design_check(path: Path, checks):
    mooring = calm.load(path)
    if checks is not None:
        mooring = Design(replace(mooring.file, checks=checks))
    result = mooring.solve()
    here, there = judged_here(mooring, result), judged_there(result)
    # the rating of a float at the surface is asked for here, as another current may take it under
    more = {key for key, (state, *_) in here.items() if state is State.UNKNOWN and key not in there}
    assert here.keys() - more == there.keys()
    assert len(more) <= reaches_the_surface(mooring.leg)
    for key, (state, value, limit) in there.items():
        assert here[key][0] is state, key
        # the anchor's rules are stated another way round: see below
        if state is not State.UNKNOWN and key[0] not in ("anchor-weight", "anchor-sliding"):
            # a result holds 32-bit numbers
            assert here[key][1:] == pytest.approx((value, limit), rel=1e-6, abs=1e-6), key


def test_the_anchor_is_judged_by_what_it_needs():
    mooring = calm.load(shipped_folder("lines") / "s1000.yaml")
    result = mooring.solve()
    load, checks = result.anchor, mooring.file.checks
    friction = mooring.file.anchor.friction or checks.anchor_friction
    here = judged_here(mooring, result)
    label = mooring.file.pieces[-1].label
    needs = pytest.approx((load.required_weight, load.weight), rel=1e-6)
    assert here["anchor-weight", label][1:] == needs
    slides = (
        load.horizontal + friction * load.vertical,
        friction * load.weight / checks.anchor_factor,
    )
    assert here["anchor-sliding", label][1:] == pytest.approx(slides, rel=1e-6)


def test_every_rule_is_judged_or_said_not_to_be():
    every = {
        limit.rule.name
        for path in MOORINGS
        for limit in limits_of(Design(replace(calm.load(path).file, checks=STRICT)))
    }
    assert every | NOT_JUDGED.keys() | {"equilibrium"} == RULES.keys()
    assert not every & NOT_JUDGED.keys()


def test_a_value_at_its_limit_is_within_it():
    mooring = calm.load(shipped_folder("lines") / "s1000.yaml")
    for limit in limits_of(mooring):
        if limit.criterion.limit is not None:
            beyond = (
                limit.criterion.limit - 1.0
                if limit.criterion.least
                else limit.criterion.limit + 1.0
            )
            values = np.array([limit.criterion.limit, beyond, np.nan])
            assert limit.broken(values).tolist() == [False, True, False]


def test_a_clamp_bears_on_the_strength_of_its_piece():
    mooring = calm.load(shipped_folder("lines") / "deep-current-meters.yaml")
    piece = next(piece for piece in mooring.file.pieces if piece.clamps)
    labels = tuple(one.label for one in mooring.file.pieces)
    clamps = tuple(clamp.label for one in mooring.file.pieces for clamp in one.clamps)
    tensions = np.where(np.array(clamps) == piece.clamps[0].label, 9000.0, 1.0)
    made = make_result(1, labels=labels, clamps=clamps, clamp_tension=tensions[None])
    greatest = {}
    with ResultColumns(made) as series:
        for limit in limits_of(mooring):
            if limit.rule.name == "strength":
                greatest[limit.criterion.part.label] = float(limit.values(series)[0])
    assert greatest.pop(piece.label) == 9000.0
    assert set(greatest.values()) == {1.0}


@pytest.mark.parametrize("name", ["s1000", "chain-and-rope-surface"])
def test_what_a_line_is_known_to_be_meant_for_is_heeded(name):
    mooring = calm.load(shipped_folder("lines") / f"{name}.yaml")
    for meant in (True, False):
        rules = {limit.rule.name for limit in limits_of(Design(mooring.file, meant))}
        assert ("reserve" in rules) is meant


def test_what_lies_on_the_seabed_is_not_slack():
    mooring = calm.load(shipped_folder("lines") / "s1000.yaml")
    labels = tuple(piece.label for piece in mooring.file.pieces)
    slack = next(limit for limit in limits_of(mooring) if limit.rule.name == "slack")
    depth = np.array([[500.0], [mooring.water.depth]]) * np.ones(len(labels))
    with ResultColumns(make_result(2, labels=labels, clamps=(), depth_top=depth)) as series:
        values = slack.values(series)
    assert values[0] == 1.0
    assert np.isnan(values[1])
