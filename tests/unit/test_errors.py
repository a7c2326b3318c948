"""The exceptions that users see: their messages, and their way between processes."""

import pickle

import pytest

from calm.errors import CalmError, InputError, NoEquilibrium, Problem, UsageError


def test_a_piece_is_counted_until_it_is_named() -> None:
    counted = NoEquilibrium("slack", "The line is slack below {piece}.", "Shorten it.", 2)
    assert counted.message == "The line is slack below piece 3."
    named = counted.naming("rope {a} (piece 4)")
    assert named.to_dict() == {
        "status": "slack",
        "message": "The line is slack below rope {a} (piece 4).",
        "advice": "Shorten it.",
    }


@pytest.mark.parametrize(
    "error",
    [
        NoEquilibrium("slack", "The line is slack below {piece}.", "Shorten it.", 2),
        InputError([Problem("mooring.yaml", 3, 1, "unknown key"), Problem("a.yaml", 1, 0, "no")]),
        UsageError("-o needs a file"),
    ],
)
def test_an_error_goes_from_one_process_to_another_as_it_is(error: CalmError) -> None:
    there = pickle.loads(pickle.dumps(error))
    assert type(there) is type(error)
    assert str(there) == str(error)
    assert vars(there) == vars(error)
