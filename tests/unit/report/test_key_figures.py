"""Key figures of a design check in its JSON, of a mooring that nobody tidied."""

import numpy as np
import pytest

from calm.checks.finding import Conclusion, State
from calm.report.check_facts import key_figures, least_factor, strongest_current
from calm.report.check_files import check_document
from calm.report.check_tables import named
from calm.report.provenance import input_hash
from tests.judged import judged

_LINE = """
line:
  - {use: sphere-steel-1250, label: Auftriebskörper ganz oben über der Übertiefe}
  - {use: wire-jacketed-8, length: 100 m, label: Draht}
  - {use: glass-17in, count: 4, label: glass}
  - {use: release-rt161, label: Auslöser}
  - {use: polyester-14, length: 100 m, label: rope}
  - {use: anchor-wheels-4, label: Räder}
"""
_HEAD = """name: Größe
environment:
  depth: 300 m
  current: {columns: [depth m, speed m/s, toward deg], rows: [[0, 0.8, 90], [300, 0.1, 60]]}
environments:
  ebb: {current: {columns: [depth m, speed m/s, toward deg], rows: [[0, 0.1, 9], [50, 1.1, 9],
    [300, 0.2, 9]]}}
"""
_ACCEPTS = """
checks:
  anchor_factor: 9
  accept:
    - {rule: strength, component: Auslöser, reason: tested to 700 bar, by: B. Li,
       date: 2026-01-02, until: 2031-12-31}
"""


@pytest.fixture(scope="module")
def assessment(tmp_path_factory):
    path = tmp_path_factory.mktemp("signed") / "größe.yaml"
    path.write_text(_HEAD + _LINE + _ACCEPTS, encoding="utf-8")
    return judged(path, "ebb")


def test_the_strongest_current_is_that_of_all_environments(assessment):
    current = strongest_current(assessment)
    assert (current.speed, current.depth) == pytest.approx((1.1, 50.0))
    assert current.environment == "ebb" and current.weak == ""


def test_a_weak_current_is_said(tmp_path):
    path = tmp_path / "weak.yaml"
    weak = "name: weak\nenvironment: {depth: 300 m, current: {speed: 0.05 m/s, toward: 9 deg}}\n"
    path.write_text(weak + _LINE, encoding="utf-8")
    told = "a wind of 7 m/s alone drives a surface current of 0.20 m/s"
    assert told in strongest_current(judged(path)).weak


def test_the_least_factor_is_that_of_every_situation(assessment):
    found = least_factor(assessment)
    assert found is not None
    results = [
        one.result for stand in assessment.in_environments for one in stand.situations if one.result
    ]
    factors = [result.components.safety_factor for result in results]
    assert found.factor == np.nanmin(factors)
    rows = {result.components.label[int(np.nanargmin(each))]
            for result, each in zip(results, factors, strict=True)
            if np.nanmin(each) == np.nanmin(factors)}  # fmt: skip
    assert found.component in rows
    assert found.unknown == np.isnan(factors[0][:-1]).sum()


def test_the_json_has_the_figures_of_page_one(assessment):
    document = check_document([assessment])
    said = document["key_figures"]["Größe"]
    assert said == key_figures(assessment)
    assert said["sha256"] == input_hash([one.leg.file for one in assessment.in_environments])
    weights = [one for one in assessment.every_finding() if one.rule == "anchor-weight"]
    assert said["anchor"]["margin"] == min(one.margin for one in weights) < 0
    assert said["anchor"]["utilisation"] == max(one.utilisation for one in weights) > 1
    assert said["counts"][State.FAIL] >= 1 and said["departures"] == ["anchor_factor"]
    assert document["verdict"] == said["verdict"] == Conclusion.FAILS and not said["draft"]


def test_labels_that_follow_are_named_as_a_run():
    assert named(["glass 1", "glass 3", "cable", "glass 2"]) == "glass 1 to 3, cable"
    assert named(["a 1", "a 3", "b", "c", "d 7", "d 8"]) == "a 1, a 3, b and 3 more"
    assert named(["300 m", "500 m"]) == "300 m, 500 m"
    assert named(["d 7", "d 8"]) == "d 7 and 8"
