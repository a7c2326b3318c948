import io
import json
from itertools import count

import pytest

import calm.verification
from tests.unit.verification.fakes import BAD, GOOD


@pytest.fixture
def cases(monkeypatch):
    """Puts sources in place of the published ones."""

    def put(*sources):
        monkeypatch.setattr(calm.verification, "SOURCES", sources)

    return put


def test_all_within_tolerance(calm, cases):
    cases(GOOD)
    done = calm("verify")
    assert (done.code, done.err) == (0, "")
    assert "Good book" in done.out
    assert done.out.endswith("Checked 2 figures of 1 source: all within tolerance\n2 published\n")


def test_a_figure_out_of_tolerance_is_exit_code_1(calm, cases):
    cases(GOOD, BAD)
    done = calm("verify")
    assert done.code == 1
    assert "! length" in done.out
    assert "ArithmeticError: no such line" in done.out


def test_words_choose_cases(calm, cases):
    cases(GOOD, BAD)
    done = calm("verify", "GOOD", "dep")
    assert done.code == 0
    assert "depth of the float" in done.out
    assert "length" not in done.out
    assert "Bad book" not in done.out


def test_words_that_no_case_has_are_told_the_sources(calm, cases):
    cases(GOOD, BAD)
    done = calm("verify", "zeppelin")
    assert (done.code, done.out) == (2, "")
    assert "no case has zeppelin" in done.err
    assert "Good book; Bad book" in done.err


def test_json_to_the_standard_output_is_all_there_is(calm, cases):
    cases(BAD)
    done = calm("verify", "--json", "-")
    assert (done.code, done.err) == (1, "")
    document = json.loads(done.out)
    assert (document["checked"], document["out"]) == (3, 2)
    assert document["cases"][1]["got"] is None


def test_json_to_a_file_beside_the_table(calm, cases, folder):
    cases(GOOD)
    done = calm("verify", "--json", "found.json")
    assert done.code == 0
    assert "Good book" in done.out
    assert json.loads((folder / "found.json").read_text())["checked"] == 2


@pytest.mark.parametrize("path", ["nowhere/found.json", "--found.json"])
def test_a_path_that_cannot_be_written_is_told_before_anything_is_computed(calm, cases, path):
    cases(BAD)
    done = calm("verify", "--json", path)
    assert (done.code, done.out) == (2, "")


def test_progress_is_told_to_a_terminal_and_wiped(cases, monkeypatch):
    from calm.cli.verify import verify

    class Terminal(io.StringIO):
        def isatty(self):
            return True

    cases(GOOD)
    terminal, seconds = Terminal(), count()
    monkeypatch.setattr("sys.stderr", terminal)
    monkeypatch.setattr("calm.cli.progress.monotonic", lambda: next(seconds))
    verify()
    assert terminal.getvalue() == "\r\x1b[K0 of 2 figures\r\x1b[K1 of 2 figures\r\x1b[K"


def test_published_figures_are_reached_from_the_command(calm):
    done = calm("verify", "cdms", "--json", "-")
    assert done.code == 0
    assert json.loads(done.out)["checked"] >= 15
