"""Moorings judged for the tests of reports, one of them with names that mean harm."""

from pathlib import Path

import calm
from calm.checks.assessment import Assessment
from calm.checks.design_check import assessment_of, environments_checked

LINES = Path(__file__).resolve().parents[1] / "lines"

SCRIPT = "</title></style></script><script>alert(1)</script>"
FORMULA = "=1+1"
QUOTES = "a & b \"c\" 'd' `e` $f_g$ {{ h }} #i"
RIGHT_TO_LEFT = "מצוף עליון عوامة"
BEYOND = "浮標 🛟 \a\x1b"
LONG = "long" * 60

_HOSTILE = """
name: {script}
description: {quotes}
environment:
  depth: 300 m
  current: {{columns: [depth m, speed m/s, toward deg], rows: [[0, 0.8, 90], [300, 0.1, 60]]}}
environments:
  {formula}: {{current: {{speed: 0.5 m/s, toward: 200 deg}}}}
  _under: {{current: {{speed: 0.3 m/s, toward: 20 deg}}}}
line:
  - {{use: sphere-steel-1250, label: {right_to_left}}}
  - {{use: wire-jacketed-8, length: 100 m, label: {quotes}, clamps: [{{use: sbe37, at: 20 m,
      label: {beyond}}}]}}
  - {{use: glass-17in, count: 4, label: {formula}}}
  - {{use: release-ar861, label: {long}}}
  - {{use: polyester-14, length: 100 m}}
  - {{use: anchor-wheels-4, label: {script}}}
"""


def judged(path: Path, *environments: str) -> Assessment:
    """The assessment of a mooring in its own environment and in others of its file."""
    moorings = [calm.load(path, environment=name) for name in (None, *environments)]
    name = moorings[0].file.name
    return assessment_of(
        name, [stand for mooring in moorings for stand in environments_checked(mooring, name)]
    )


def without_checks(name: str) -> str:
    """The text of a line of `lines/` up to its limits and what it accepts, if it has these."""
    text, _, _ = (LINES / f"{name}.yaml").read_text(encoding="utf-8").partition("\nchecks:\n")
    return text


def unaccepting(name: str, folder: Path) -> Path:
    """A line of `lines/` that accepts nothing and may not move: some fails, some is unknown."""
    path = folder / name
    text = without_checks(path.stem).replace("label: swivel}", "label: swivel, estimate: []}")
    path.write_text(f"{text}\nchecks: {{maximum_excursion: 1 cm}}\n", encoding="utf-8")
    return path


def hostile_file(folder: Path) -> Path:
    """A mooring file whose every name is a trap."""
    names = {
        "script": SCRIPT,
        "quotes": QUOTES,
        "formula": FORMULA,
        "right_to_left": RIGHT_TO_LEFT,
        "beyond": BEYOND,
        "long": LONG,
    }
    path = folder / "hostile.yaml"
    path.write_text(_HOSTILE.format(**{key: _yaml(text) for key, text in names.items()}), "utf-8")
    return path


def judged_hostile(folder: Path) -> Assessment:
    return judged(hostile_file(folder), FORMULA, "_under")


def _yaml(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + escaped.replace("\a", "\\a").replace("\x1b", "\\e") + '"'
