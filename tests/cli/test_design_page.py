"""The page on explaining and sizing shows what the commands print, and its examples run."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "reference" / "design.md"
SHOWN = re.findall(
    r"^<!-- printed by: calm ([^\n]+) -->\n```text\n(.*?)^```$",
    PAGE.read_text(encoding="utf-8"),
    re.MULTILINE | re.DOTALL,
)


@pytest.mark.parametrize(("command", "shown"), SHOWN, ids=[command[-13:] for command, _ in SHOWN])
@pytest.mark.thorough
def test_the_page_shows_what_is_printed(command, shown):
    finished = subprocess.run(
        [sys.executable, "-m", "calm", *shlex.split(command)],
        cwd=ROOT,
        env={**os.environ, "COLUMNS": "100", "NO_COLOR": "1"},
        capture_output=True,
        encoding="utf-8",
        check=True,
    )
    printed = "\n".join(line.rstrip() for line in finished.stdout.splitlines())
    # The page leaves the table of `calm run` out; how many solves it took may differ.
    start = max(printed.find("Causes of"), printed.find("Uncertainty"), 0)
    printed = printed[start:].partition("Found after")[0]
    assert shown.partition("Found after")[0].strip() == printed.strip()


def test_all_commands_are_shown():
    assert [command.split()[0] for command, _ in SHOWN] == ["run", "run", "size"]


@pytest.mark.thorough
def test_the_examples_in_python_run():
    examples = re.findall(
        r"^```python\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL
    )
    assert len(examples) == 2
    finished = subprocess.run(
        [sys.executable, "-W", "error", "-c", "\n".join(examples)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert finished.returncode == 0, finished.stderr
    assert "met" in finished.stdout
