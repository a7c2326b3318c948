"""The manual and the README say what the program does."""

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
README = ROOT / "README.md"
TOW = ROOT / "docs" / "reference" / "tow.md"
PAGES = [README, *sorted((ROOT / "docs").rglob("*.md"))]


def blocks(page: Path, language: str) -> list[str]:
    """Contents of the fenced blocks of one language."""
    text = page.read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def readme_command(name: str) -> str:
    """The command that stands under the comment `<!-- name -->`."""
    text = README.read_text(encoding="utf-8")
    found = re.search(rf"^<!-- {name} -->\n```sh\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    assert found is not None, name
    return found[1].strip()


def calm_prints(*arguments: str) -> str:
    finished = subprocess.run(
        [sys.executable, "-m", "calm", *arguments],
        cwd=ROOT,
        env={**os.environ, "COLUMNS": "100", "NO_COLOR": "1", "CALM_COMPILED": "never"},
        capture_output=True,
        encoding="utf-8",
        check=True,
    )
    return finished.stdout


@pytest.mark.parametrize("what", ["command_line", "rules", "columns"])
def test_commands_rules_and_columns_are_in_the_manual_as_they_are(what: str) -> None:
    finished = subprocess.run(
        [sys.executable, ROOT / "docs" / f"generate_{what}.py", "--check"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert finished.returncode == 0, finished.stderr


def test_every_command_is_explained_in_the_readme_or_the_manual() -> None:
    reference = (ROOT / "docs" / "reference" / "command-line.md").read_text(encoding="utf-8")
    commands = [name for name in re.findall(r"^## (calm .+)$", reference, re.MULTILINE)]
    assert "calm run" in commands
    explained = "\n".join(
        page.read_text(encoding="utf-8") for page in PAGES if page.name != "command-line.md"
    )
    assert not [command for command in commands if command not in explained]


def test_the_readme_is_read_in_a_minute() -> None:
    assert len(README.read_text(encoding="utf-8").splitlines()) <= 120


def test_the_citation_names_this_version_and_licence() -> None:
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert (cited["version"], cited["license"]) == (project["version"], project["license"])
    assert {"cff-version", "message", "title", "authors"} <= set(cited)


def test_links_to_the_glossary_lead_to_a_term() -> None:
    glossary = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")
    terms = {
        term.lower().replace(" ", "-") for term in re.findall(r"^## (.+)$", glossary, re.MULTILINE)
    }
    linked = {
        term
        for page in PAGES
        for term in re.findall(r"glossary\.md#([\w-]+)", page.read_text(encoding="utf-8"))
    }
    assert {"knockdown", "strumming", "back-up", "scope"} <= terms
    assert linked <= terms


def test_the_checks_run_the_commands_of_the_readme() -> None:
    script = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    names = re.findall(r"^readme (\S+)$", script, re.MULTILINE)
    assert set(names) == {"install-and-run", "install-and-test"}
    for name in names:
        assert len(readme_command(name).splitlines()) == 1
    assert "calm run lines/" in readme_command("install-and-run")
    assert "pytest" in readme_command("install-and-test")


@pytest.mark.parametrize("page", [README, TOW], ids=lambda page: page.name)
def test_a_page_shows_what_the_command_prints(page: Path) -> None:
    shown = re.findall(r"^<!-- printed by: calm ([^\n]+) -->\n```text\n(.*?)^```$",
                       page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)  # fmt: skip
    assert shown
    for command, text in shown:
        printed = "\n".join(line.rstrip() for line in calm_prints(*command.split()).splitlines())
        # The last sentence of a line tells residuals at the level of rounding, which differ
        # between machines.
        assert text.partition("Converged")[0].rstrip() == printed.partition("Converged")[0].rstrip()


@pytest.mark.parametrize(
    "page", [README, ROOT / "docs" / "reference" / "python.md", TOW], ids=lambda page: page.name
)
@pytest.mark.thorough
def test_python_examples_run(page: Path, tmp_path: Path) -> None:
    examples = blocks(page, "python")
    assert examples
    for folder in ("lines", "docs"):
        (tmp_path / folder).symlink_to(ROOT / folder)
    finished = subprocess.run(
        [sys.executable, "-W", "error", "-c", "\n".join(examples)],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert finished.returncode == 0, finished.stderr


@pytest.mark.parametrize(
    "page",
    [README, ROOT / "docs" / "reference" / "mooring-file.md", TOW],
    ids=lambda page: page.name,
)
def test_moorings_shown_are_solved(page: Path, tmp_path: Path) -> None:
    file = tmp_path / "mooring.yaml"
    file.write_text(blocks(page, "yaml")[0], encoding="utf-8")
    assert re.search("^(Anchor|Tow point) +", calm_prints("run", str(file)), re.MULTILINE)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    links = [link for link in re.findall(r"\]\(([^)#]+)", text) if "://" not in link]
    assert not [link for link in links if not (page.parent / link).exists()]
