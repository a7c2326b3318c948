"""What is said of a line without an equilibrium."""

from calm.errors import NoEquilibrium


def test_a_piece_is_counted_until_it_is_named() -> None:
    counted = NoEquilibrium("slack", "The line is slack below {piece}.", "Shorten it.", 2)
    assert counted.message == "The line is slack below piece 3."
    named = counted.naming("rope {a} (piece 4)")
    assert named.to_dict() == {
        "status": "slack",
        "message": "The line is slack below rope {a} (piece 4).",
        "advice": "Shorten it.",
    }
