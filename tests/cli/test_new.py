import json
import os

import pytest
from jsonschema import Draft202012Validator

from calm.shipped import TEMPLATES
from tests.core_yaml import loaded


def test_new_prints_a_commented_file(calm):
    done = calm("new")
    assert done.code == 0
    assert done.err == ""
    assert done.out.count("#") > 5


def test_new_runs_as_it_stands(calm, folder):
    done = calm("new", "-o", "m.yaml")
    assert (done.code, done.out) == (0, "")
    assert "calm run m.yaml" in done.err
    assert os.listdir(folder) == ["m.yaml"]
    document = json.loads(calm("run", "m.yaml", "--json", "-").out)
    assert document["status"] == "converged"
    leaning = json.loads(calm("run", "m.yaml", "--environment", "storm", "--json", "-").out)
    assert leaning["top"]["knockdown"] > document["top"]["knockdown"]


@pytest.mark.parametrize("environment", [[], ["--environment", "storm"]])
def test_new_is_a_good_design(calm, environment):
    calm("new", "-o", "m.yaml")
    document = json.loads(calm("run", "m.yaml", *environment, "--json", "-").out)
    assert document["anchor"]["weight"] > document["anchor"]["required_weight"]
    factors = [row["safety_factor"] for row in document["components"] if row["safety_factor"]]
    assert min(factors) > 5.0


@pytest.mark.parametrize("kind", TEMPLATES)
def test_each_kind_stands_and_nothing_is_unknown(calm, kind):
    calm("new", kind, "-o", "m.yaml")
    if kind == "tow":
        body = json.loads(calm("run", "m.yaml", "--json", "-").out)["body"]
        assert body["depth"] == pytest.approx(70.0, abs=0.2)
        return
    done = calm("check", "m.yaml", "--json", "-")
    document = json.loads(done.out)
    assert not {"fail", "unknown"} & {each["state"] for each in document["findings"]}
    assert {each["by"] for each in document["accepted"]} <= {"EXAMPLE"}
    assert done.code == 0


def test_of_kinds_that_are_not_there_the_others_are_named(calm):
    done = calm("new", "taut")
    assert done.code == 2 and "taut-surface" in done.err


def test_new_overwrites_only_when_told(calm, folder):
    (folder / "m.yaml").write_text("mine")
    done = calm("new", "-o", "m.yaml")
    assert done.code == 2
    assert "--force" in done.err
    assert (folder / "m.yaml").read_text() == "mine"
    assert calm("new", "-o", "m.yaml", "--force").code == 0
    assert calm("new", "--output", "missing/m.yaml").code == 2


def test_new_record_is_one_that_the_starter_stands_in(calm, folder):
    calm("new", "-o", "m.yaml")
    done = calm("new", "--record", "-o", "r.nc")
    assert (done.code, done.out) == (0, "")
    assert "calm batch FILE --currents r.nc -o r-result.nc" in done.err
    text = (folder / "m.yaml").read_text()
    start, end = text.index("  current:"), text.index("line:")
    current = '  current: {file: r.nc, time: "2026-03-19T12:00"}\n\n'  # the height of the surge
    (folder / "s.yaml").write_text(text[:start] + current + text[end:])
    document = json.loads(calm("run", "s.yaml", "--json", "-").out)
    assert document["status"] == "converged"
    assert document["warnings"] == []
    first = (folder / "r.nc").read_bytes()
    assert calm("new", "--record", "-o", "r.nc").code == 2
    assert calm("new", "--record", "-o", "r.nc", "--force").code == 0
    assert (folder / "r.nc").read_bytes() == first


def test_new_record_goes_to_a_file(calm):
    done = calm("new", "--record")
    assert (done.code, done.out) == (2, "")
    assert "--output record.nc" in done.err


def test_schema_accepts_the_starter(calm):
    schema = json.loads(calm("schema").out)
    Draft202012Validator.check_schema(schema)
    starter = loaded(calm("new").out)
    assert list(Draft202012Validator(schema).iter_errors(starter)) == []
