import itertools
import os
import re
import subprocess
import sys

import pytest

import calm as package
from calm import version
from calm.cli.outputs import ExitCode, gravest, narrate, show
from calm.errors import UsageError


def test_version(calm):
    done = calm("--version")
    commit = version.built_from()
    said = f"{package.__version__} (commit {commit})" if commit else package.__version__
    assert (done.code, done.out) == (0, f"{said}\n")


def test_the_commit_is_the_built_one_then_that_of_the_checkout(tmp_path, monkeypatch):
    package = tmp_path / "calm"
    (package / "_shipped").mkdir(parents=True)
    monkeypatch.setattr(version, "__file__", str(package / "version.py"))
    assert version.built_from() == ""
    git = ["git", "-C", str(tmp_path), "-c", "user.name=A", "-c", "user.email=a@b"]
    subprocess.run(["git", "init", "-q", str(tmp_path)], check=True)
    subprocess.run([*git, "commit", "-q", "--allow-empty", "-m", "One"], check=True)
    newest = subprocess.run(
        [*git, "rev-parse", "--short", "HEAD"], check=True, capture_output=True, text=True
    ).stdout.strip()
    assert version.built_from() == newest
    (package / "_shipped" / "commit").write_text("4c1fd21\n")
    assert version.built_from() == "4c1fd21"


def test_no_words_show_the_help(calm):
    assert calm().out == calm("--help").out
    assert calm().code == 0


@pytest.mark.parametrize(
    "command",
    [
        "run",
        "new",
        "schema",
        "docs",
        "catalog",
        "catalog list",
        "catalog show",
        "catalog add",
        "catalog check",
    ],
)
def test_help_of_every_command_shows_an_example(calm, command):
    done = calm(*command.split(), "--help")
    assert done.code == 0
    assert done.err == ""
    assert done.out.startswith(f"Usage: calm {command}")
    assert "Examples:" in done.out
    assert f"  calm {command}" in done.out


def test_paragraphs_of_the_help_are_wrapped_to_the_width(calm, monkeypatch):
    monkeypatch.setenv("COLUMNS", "130")
    lines = calm("check", "--help").out.splitlines()
    first = lines.index(next(one for one in lines if one.startswith("Each mooring is solved")))
    paragraph = lines[first : lines.index("", first)]
    assert len(paragraph) > 2 and all(len(one) > 110 for one in paragraph[:-1])


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["rn", "m.yaml"], '"run"'),
        (["run"], "`calm run` needs FILE...; see `calm run --help`"),
        (["motion", "m.yaml"], "`calm motion` needs --pressures FILE and -o PATH; see"),
        (["motion", "m.yaml", "--pressure", "p.nc"], "did you mean --pressures for --pressure?"),
        (["batch"], "`calm batch` needs FILE, --currents FILE and -o PATH; see"),
        (["batch", "m.yaml", "--currents"], "`calm batch`: --currents needs a value: --currents F"),
        (["grid", "d.nc"], "`calm grid` needs VALUES..., -o PATH and --levels LEVELS; see"),
        (["catalog", "add", "ours"], "`calm catalog add` needs KEY=VALUE...; see"),
        (["run", "m.yaml", "--enviroment", "x"], "--environment"),
        (["catalog", "shwo", "x"], '"show"'),
        (["catalog", "list", "--kind", "rope"], "chain"),
        (["schema", "m.yaml"], "unexpected argument: m.yaml"),
    ],
)
def test_wrong_usage_is_one_line_with_the_nearest(calm, words, told):
    done = calm(*words)
    assert done.code == 2
    assert done.out == ""
    assert len(done.err.splitlines()) == 1
    assert told in done.err


def test_a_file_without_its_command(calm, write_mooring):
    done = calm(write_mooring())
    assert done.code == 2
    assert done.err == (
        "calm: `m.yaml` is a file, not a command; see `calm --help`, or `calm run m.yaml`\n"
    )


def test_interrupt(calm, write_mooring, monkeypatch):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("calm.case.load", interrupted)
    done = calm("run", write_mooring())
    assert done.code == 130
    assert done.err == "calm: interrupted\n"


def test_a_bug_is_one_line_unless_debugging(calm, write_mooring, monkeypatch):
    def bug(*_, **__):
        raise ZeroDivisionError("of all things")

    monkeypatch.setattr("calm.case.load", bug)
    done = calm("run", write_mooring())
    assert done.code == 70
    assert done.err == (
        "calm: internal error (ZeroDivisionError: of all things); please report it\n"
    )
    monkeypatch.setenv("CALM_DEBUG", "1")
    assert "Traceback" in calm("run", "m.yaml").err


def test_gravest_code_is_the_first_of_2_3_1_0():
    assert gravest([]) is ExitCode.DONE
    assert gravest([ExitCode.DONE, ExitCode.FINDING]) is ExitCode.FINDING
    assert gravest([ExitCode.FINDING, ExitCode.NO_EQUILIBRIUM]) is ExitCode.NO_EQUILIBRIUM
    assert gravest([ExitCode.NO_EQUILIBRIUM, ExitCode.BAD_INPUT]) is ExitCode.BAD_INPUT


def test_process_hands_on_the_exit_code(calm_process, broken):
    done = calm_process("run", broken)
    assert done.returncode == 2
    assert done.stdout == ""
    assert "Traceback" not in done.stderr


@pytest.mark.usefixtures("march_as_it_stands")
def test_reader_that_stops_early_is_no_error(write_mooring):
    done = subprocess.run(
        f"set -o pipefail; {sys.executable} -m calm run {write_mooring()} | true",
        shell=True,
        executable="/bin/bash",
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a device that is always full")
@pytest.mark.parametrize("option", [["--json", "-"], []])
def test_full_disk_behind_the_standard_output(calm_process, write_mooring, option):
    with open("/dev/full", "w") as full:
        done = calm_process(
            "run", write_mooring(), *option, capture_output=False, stdout=full,
            stderr=subprocess.PIPE,
        )  # fmt: skip
    assert done.returncode == 2
    assert done.stderr == "calm: cannot write to the standard output: No space left on device\n"


def test_full_disk_behind_a_file(calm, write_mooring, monkeypatch):
    def full(*_):
        raise UsageError("cannot write x.json: No space left on device")

    monkeypatch.setattr("calm.report.folder.write_file", full)
    done = calm("run", write_mooring(), "-o", "x.json")
    assert done.code == 2
    assert done.err == "calm: cannot write x.json: No space left on device\n"


def test_signs_a_terminal_cannot_show_stop_nothing(calm_process, write_mooring):
    environment = os.environ | {"PYTHONIOENCODING": "ascii"}
    done = calm_process("run", write_mooring(name="Bouée"), env=environment)
    assert done.returncode == 0
    assert done.stdout.startswith("Bou?e: ")


@pytest.mark.parametrize(
    ("variables", "coloured"),
    [({}, False), ({"FORCE_COLOR": "1"}, True), ({"FORCE_COLOR": "1", "NO_COLOR": "1"}, False)],
)
@pytest.mark.thorough
def test_colour_only_where_it_is_wanted(calm_process, write_mooring, variables, coloured):
    file = write_mooring(speed="2 m/s", buoyancy="4000 N")  # has a warning, which is red
    environment = os.environ | {"TERM": "xterm-16color"} | variables
    done = calm_process("run", file, env=environment)
    assert done.returncode == 0
    assert ("\x1b[1;31m" in done.stdout) is coloured


def test_texts_of_options_are_set_to_the_width_of_the_terminal(calm, monkeypatch):
    """A word that would have fitted on the line above is not on a line of its own."""
    monkeypatch.setenv("COLUMNS", "80")
    _, *texts = re.split(r"^│ --", calm("run", "--help").out, flags=re.MULTILINE)
    assert len(texts) > 8
    for text in texts:
        cells = [line.strip("│ ") for line in text.split("╰")[0].splitlines()]
        room = 78 - len("│ --output -o PATH...  ")
        for above, below in itertools.pairwise(cells[1:]):
            assert len(above) + 1 + len(below.split()[0]) > room


@pytest.mark.parametrize("sign", ["\x1b", "\x07", "\x08", "\r", "\x9b", "\u202e"])
def test_no_text_of_a_file_steers_the_terminal(sign, capsys, monkeypatch):
    """A record's title may hold what clears a screen or writes a window's title: it is shown."""
    text = f"title {sign}]0;x{sign}[2J of a record\n"
    narrate(text)
    show(text)
    printed = capsys.readouterr()
    assert sign not in printed.err
    assert printed.out == text, "data in a pipe are what they are"
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True, raising=False)
    show(text)
    assert sign not in capsys.readouterr().out
