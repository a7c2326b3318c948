"""Rules for the text of the project itself."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TEXT = {".py", ".md", ".yaml", ".toml", ".txt", ".json", ""}
MODULES = sorted((ROOT / "calm").rglob("*.py"))


def text_files() -> list[Path]:
    """Every text file of the project; folders of tools (caches, environments) begin with a dot."""
    folders = ("calm", "catalog", "lines", "tests", "benchmarks", "docs", ".ci")
    found = [path for folder in folders for path in (ROOT / folder).rglob("*")]
    return sorted(
        path
        for path in [*ROOT.glob("*"), *found]
        if path.is_file()
        and path.suffix in TEXT
        and path.name != ".git"  # of a work tree of its own
        and "__pycache__" not in path.parts
        and not any(part.startswith(".") for part in path.relative_to(ROOT).parts[1:])
    )


def test_no_file_names_a_place_on_one_machine() -> None:
    place = re.compile(r"(?<![\w.$}/*])/(?:home|root|tmp|opt|mnt|Users|work)/|file://")
    found = [
        f"{path.relative_to(ROOT)}:{number}"
        for path in text_files()
        if path != Path(__file__)
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1)
        if place.search(line)
    ]
    assert not found


def test_modules_are_named_for_what_they_do() -> None:
    vague = {"utils", "util", "helpers", "common", "misc", "tools"}
    assert not [path for path in MODULES if path.stem in vague]


def test_data_folders_hold_data() -> None:
    kinds = {
        path.suffix for folder in ("catalog", "lines") for path in (ROOT / folder).rglob("*.*")
    }
    assert kinds <= {".yaml", ".json", ".csv", ".nc"}
