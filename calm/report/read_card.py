"""What was read from files, for a terminal and for reports: a list of names and values a file."""

from collections.abc import Iterable, Mapping
from typing import Any

from calm.records.card import card_rows
from calm.report.blocks import Block, Heading, Pairs


def card_blocks(cards: Iterable[Mapping[str, Any]]) -> tuple[Block, ...]:
    """Return each file's card, as `calm.records.card.ReadCard.to_dict` gives it."""
    return tuple(
        block for card in cards for block in (Heading(str(card["file"])), Pairs(card_rows(card)))
    )
