"""What was done can be taken back, all of it."""

from calm.files.editing import Draft, History


def test_undo_and_redo() -> None:
    start = Draft.empty()
    history = History(start)
    assert history.undo() is None and history.redo() is None and not history.changed
    for depth in range(500):
        history.do(history.draft.put_at(("environment", "depth"), f"{depth} m"), f"depth {depth}")
    assert history.changed
    assert history.undo() == "depth 499"
    assert history.draft.value(("environment", "depth")) == "498 m"
    assert history.redo() == "depth 499"
    assert sum(1 for _ in iter(history.undo, None)) == 500
    assert history.draft.text == start.text and not history.changed


def test_a_new_edit_forgets_what_was_undone_and_an_equal_one_is_none() -> None:
    history = History(Draft("name: a\n"))
    history.do(Draft("name: b\n"), "b")
    history.undo()
    history.do(Draft("name: a\n"), "none")
    assert history.redo() == "b"
    history.undo()
    history.do(Draft("name: c\n"), "c")
    assert history.redo() is None


def test_changed_is_against_what_was_saved() -> None:
    history = History(Draft("name: a\n"))
    history.do(Draft("name: b\n"), "b")
    history.saved()
    assert not history.changed
    history.undo()
    assert history.changed
    history.saved("name: a\n")
    assert not history.changed
