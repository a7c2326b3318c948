"""Which part of one line is which of another."""

import pytest

from calm.files.file_differences import Alignment, Known, align, own_labels


def line(words: str) -> list[Known]:
    """A line of parts: `label=use`, or a use alone, which then is the label."""
    parts = [word.partition("=") for word in words.split()]
    labels = own_labels([label for label, _, _ in parts])
    uses = [use or label for label, _, use in parts]
    return [Known(label, ((label, use), use)) for label, use in zip(labels, uses, strict=True)]


def numbered(words: str) -> list[Known]:
    """A line of uses, numbered as the reader does."""
    uses = words.split()
    labels = [
        f"{use} {uses[: n + 1].count(use)}" if uses.count(use) > 1 else use
        for n, use in enumerate(uses)
    ]
    own = own_labels(labels)
    return [Known(label, ((label, use), use)) for label, use in zip(own, uses, strict=True)]


def test_numbers_from_one_are_no_labels() -> None:
    assert own_labels(["s 1", "wire", "s 2", "CTD 130", "CTD 230", "one 1"]) == [
        "s", "wire", "s", "CTD 130", "CTD 230", "one 1",
    ]  # fmt: skip


def test_the_same_line() -> None:
    parts = numbered("float s wire s release s anchor")
    assert align(parts, parts) == Alignment(tuple((i, i) for i in range(7)), frozenset(), (), ())


@pytest.mark.parametrize(
    ("before", "after", "pairs", "removed", "added"),
    [
        # a shackle put in at the top renumbers those below it
        ("float wire s meter s anchor", "float s wire s meter s anchor",
         [(0, 0), (1, 2), (2, 3), (3, 4), (4, 5), (5, 6)], [], [1]),
        # a meter taken out of several alike that nothing tells apart but their place
        ("float s m s m s m anchor", "float s m s m anchor",
         [(0, 0), (1, 1), (2, 2), (3, 3), (4, 4), (7, 5)], [5, 6], []),
        ("a b c", "", [], [0, 1, 2], []),
        ("", "a b", [], [], [0, 1]),
    ],
)  # fmt: skip
def test_put_in_and_taken_out(
    before: str,
    after: str,
    pairs: list[tuple[int, int]],
    removed: list[int],
    added: list[int],
) -> None:
    found = align(numbered(before), numbered(after))
    assert (list(found.pairs), list(found.removed), list(found.added)) == (pairs, removed, added)
    assert not found.moved


def test_another_component_under_its_label() -> None:
    found = align(line("top=ball wire=w8 anchor"), line("top=sphere wire=w10 anchor"))
    assert found.pairs == ((0, 0), (1, 1), (2, 2))


def test_a_new_label_of_the_same_component() -> None:
    found = align(line("top=ball low=wire anchor"), line("top=ball deep=wire anchor"))
    assert found.pairs == ((0, 0), (1, 1), (2, 2))


def test_what_is_moved_is_not_taken_out() -> None:
    found = align(
        line("top swivel wire meter rope anchor"), line("top wire meter rope swivel anchor")
    )
    assert found.moved == {(1, 4)}
    assert not found.removed and not found.added
    # two without labels of their own, too
    found = align(numbered("top s a b s c anchor"), numbered("top a s b s c anchor"))
    assert found.moved == {(1, 2)} or found.moved == {(2, 1)}


def test_a_long_line_is_aligned_in_little_time() -> None:
    uses = " ".join(f"wire{n} s meter s" for n in range(1000))
    found = align(numbered(f"float {uses}"), numbered(f"float s {uses}"))
    assert found.added == (1,)
    assert len(found.pairs) == 4001
