"""What was done to a draft, without limit, and how to take it back."""

from __future__ import annotations

from calm.files.editing.draft import Draft


class History:
    """Keep a draft and the states before and after it.

    Parameters
    ----------
    draft : Draft
        As it is saved.
    """

    def __init__(self, draft: Draft) -> None:
        self.draft = draft
        self._saved = draft.text
        # Texts only: the nodes of thousands of drafts would take much memory.
        self._done: list[tuple[str, str]] = []
        self._undone: list[tuple[str, str]] = []

    @property
    def changed(self) -> bool:
        """Return whether the draft differs from what was saved."""
        return self.draft.text != self._saved

    @property
    def saved_text(self) -> str:
        """Return what was saved."""
        return self._saved

    @property
    def steps(self) -> tuple[str, ...]:
        """Return what was done and can be taken back, the last first."""
        return tuple(label for label, _ in reversed(self._done))

    def do(self, draft: Draft, label: str) -> None:
        """Take a new state, and what it came of; an equal one is none."""
        if draft.text == self.draft.text:
            return
        self._done.append((label, self.draft.text))
        self._undone.clear()
        self.draft = draft

    def undo(self) -> str | None:
        """Go back a step; what was taken back."""
        return self._go(self._done, self._undone)

    def redo(self) -> str | None:
        """Go forward again; what was done again."""
        return self._go(self._undone, self._done)

    def saved(self, text: str | None = None) -> None:
        """Take the draft, or another text, for what is now saved."""
        self._saved = self.draft.text if text is None else text

    def _go(self, source: list[tuple[str, str]], target: list[tuple[str, str]]) -> str | None:
        if not source:
            return None
        label, text = source.pop()
        target.append((label, self.draft.text))
        self.draft = Draft(text)
        return label
