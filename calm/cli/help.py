"""Formatting of `--help`: width, names of values, and examples."""

from __future__ import annotations

import re
from collections.abc import Callable
from inspect import cleandoc
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cyclopts.help import HelpPanel
    from rich.console import Console, ConsoleOptions

_VALUES = {
    "FILE|-": "json",
    "FILE": "plot catalog currents pressures sea-level onto against update scatter elements",
    "DIR": "report",
    "NAME": "environment sheet",
    "LABEL,...": "hold-out without",
    "LAT,LON": "at near",
    "LETTERS": "hemisphere",
    "LENGTH": "diameter streamed length distance",
    "DEPTH": "depth transducer",
    "HEIGHT": "above-seabed height hs",
    "ANGLE": "course declination toward phi-a phi-b",
    "SPEED": "speed ship-speed",
    "RANGE": "speeds",
    "CONDITION": "target",
    "CHANGE": "change",
    "FLAGS": "flags",
    "WORD": "match format to method",
    "WORD,...": "correct fit variables",
    "LEVELS": "levels",
    "VALUE": "between",
    "SPEED|FILE": "sound-speed",
    "COLUMNS": "columns",
    "NUMBER": "k cd",
    "A/B": "time",
    "TIME": "gap step tp duration",
    "COUNT": "samples workers",
    "N": "every",
    "ADDRESS": "scheduler",
    "DENSITY": "density",
    "N/m": "weight",
    "FORCE": "tension-a tension-b",
    "UNITS": "units",
    "WORD|FILE": "spectrum",
    "NAME=VALUE": "define",
}
"""Names of values in `--help`, with their options. Options that are not listed show their type."""

_VALUE_OF = {f"--{name}": value for value, names in _VALUES.items() for name in names.split()}


def metavar(option: str) -> str | None:
    """Return the name of an option's value in `--help`; None if the option shows its type."""
    return _VALUE_OF.get(option)


class HelpAtWidth:
    """Formatter of `--help` that fills the terminal width and names the value of each option."""

    def __call__(self, console: Console, options: ConsoleOptions, panel: HelpPanel) -> None:
        from cyclopts.help import DefaultFormatter

        for place, entry in enumerate(panel.entries):
            _rewrap(entry.description)
            if entry.choices is not None and len(entry.choices) == 1:
                panel.entries[place] = entry.copy(metavar=entry.choices[0], choices=None)
                continue
            value = next((_VALUE_OF[name] for name in entry.names if name in _VALUE_OF), None)
            if value and entry.metavar:
                several = "..." if entry.metavar.endswith("...") else ""
                panel.entries[place] = entry.copy(metavar=f"{value}{several}")
        DefaultFormatter()(console, options, panel)

    def render_description(self, console: Console, options: ConsoleOptions, text: Any) -> None:
        """Print the description of a command, with its paragraphs wrapped to the width."""
        from cyclopts.help import DefaultFormatter

        _rewrap(text)
        DefaultFormatter().render_description(console, options, text)

    def render_usage(self, console: Console, options: ConsoleOptions, usage: Any) -> None:
        """Print the usage line with the name of each value instead of its type."""
        from cyclopts.help import DefaultFormatter

        known = re.compile(r"(--[\w-]+) ([A-Z]+)")
        text = known.sub(lambda m: f"{m[1]} {_VALUE_OF.get(m[1], m[2])}", str(usage))
        DefaultFormatter().render_usage(console, options, text)


def _rewrap(text: Any) -> None:
    """Join the lines of each paragraph of a help text, so that it is wrapped when it is printed."""
    from rich.text import Text

    written = getattr(text, "primary_renderable", None)
    if isinstance(written, Text):
        paragraphs = written.plain.split("\n\n")
        text.primary_renderable = Text("\n\n".join(" ".join(one.split()) for one in paragraphs))


def examples(command: Callable[..., object]) -> str:
    """Return the examples from the end of a command's docstring, to be shown at the end of
    `--help`.
    """
    text = cleandoc(command.__doc__ or "").partition("Examples\n--------\n")[2]
    return f"Examples:\n\n{text}"
