"""What is asked about unsaved work of an earlier session."""

from __future__ import annotations

import time

from calm.files.editing import KeptWork
from calm.tui.dialogs import Answer, Question
from calm.tui.session import Session


def moment(seconds: float) -> str:
    """A time [s since 1970] as the clock on the wall shows it, to the minute."""
    return time.strftime("%Y-%m-%d at %H:%M", time.localtime(seconds))


def offer(session: Session, kept: KeptWork) -> Question:
    """Whether it is to be recovered; it says when it was kept and whether the file is newer."""
    whose = "" if kept.keeper.is_here else f" on {kept.keeper.host}, where it may still be open"
    sentences = [f"An earlier run ended before {session.name} was saved. It kept its work"]
    sentences.append(f"{moment(kept.at)}{whose}.")
    if session.file.is_of_another(kept):
        stamp = session.file.stamp
        sentences.append(
            "The file is gone since that work was begun: saving writes it again."
            if stamp is None
            else f"The file was changed, {moment(stamp[0] / 1e9)}, after that work was begun: "
            "saving will ask."
        )
    answers = [
        Answer("r", "recover it; undo goes back to the file", "recover"),
        Answer("k", "keep it for later; go on with the file", "later"),
        Answer("d", "throw it away", "discard"),
    ]
    return Question("Work that was not saved", " ".join(sentences), answers, must=True)


def confirmation(kept: KeptWork) -> Question:
    """Whether it is really to be thrown away: nothing brings it back."""
    answers = [Answer("y", "yes, throw it away for good", "discard")]
    return Question("Throw the work away?", f"It was kept {moment(kept.at)}.", answers)
