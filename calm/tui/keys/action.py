"""An action that keys are bound to, and the places where keys work."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Place = Literal[
    "anywhere", "line", "verdict", "catalogue", "cell", "water", "grid", "choice", "given", "text",
    "area", "form", "sheet", "question", "help",
]  # fmt: skip
"""Where the keys of an action work: what has the focus, or the screen it is on."""

PLACES: dict[Place, str] = {
    "line": "The line",
    "anywhere": "Anywhere on the first screen",
    "verdict": "The verdict, line by line",
    "cell": "While a value is edited in place",
    "catalogue": "The catalogue",
    "water": "The water",
    "grid": "A table of the water",
    "choice": "One of some words between arrows",
    "given": "The form in which density or current is given",
    "text": "The file as text",
    "area": "While the text is typed",
    "form": "A component of your own",
    "sheet": "Some values asked for together",
    "question": "A question, answered by the letter in front of each answer",
    "help": "This help",
}
"""The headings of the help, in its order."""


@dataclass(frozen=True)
class Action:
    """A verb.

    Attributes
    ----------
    place : where its keys work
    name : of the method, without ``action_``, with its arguments
    keys : as textual writes them, separated by commas; the first is the one that is shown
    title : two or three words, for the palette and the line of keys
    meaning : a sentence for the help
    hint : its rank in the line of keys, 0 the first; None where it is not among them
    palette : whether the command palette offers it
    """

    place: Place
    name: str
    keys: str
    title: str
    meaning: str
    hint: int | None = None
    palette: bool = True
