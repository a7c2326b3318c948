"""What is asked about a whole line: what to begin with, and how far to go back."""

from __future__ import annotations

from calm.templates import TEMPLATES
from calm.tui.dialogs import Answer, Asked, Question, Sheet
from calm.tui.session import Session

_MOST_STEPS = 9


def beginning() -> Question:
    """Ask with which of the `TEMPLATES` an empty line begins; the answer is its number, from 1."""
    answers = [
        Answer(str(number), f"{kind}: {meaning}", str(number))
        for number, (kind, meaning) in enumerate(TEMPLATES.items(), 1)
    ]
    text = "Each stands as given: change depth, current and pieces to yours."
    return Question("Begin with", text, answers)


def history(session: Session) -> Question:
    """How many steps to take back, the last ones listed; it answers with their number."""
    steps = session.history.steps
    answers = [
        Answer(str(number), f"before: {label}", str(number))
        for number, label in enumerate(steps[:_MOST_STEPS], 1)
    ]
    more = len(steps) - _MOST_STEPS
    text = f"Go back to before one of the last {len(answers)} changes; U does them again."
    text += f" {more} are older; u goes back one by one." if more > 0 else ""
    return Question("What was done", text, answers)


def naming(session: Session) -> Sheet:
    """The id of an assembly that is made of marked pieces."""
    from calm.tui.catalogue.component_form import id_check

    own = session.draft.value(("components",))
    check = id_check(own if isinstance(own, dict) else ())
    asked = [Asked("id", "Id", check=check, placeholder="e.g. glass-pack-own")]
    text = "The pieces go into the file's components; `use` of this id stands for them."
    return Sheet("Make an assembly", text, asked)
