"""Summary of the data read from files, for terminals and reports."""

from collections.abc import Iterable, Mapping
from typing import Any

from calm.records.card import card_rows
from calm.report.blocks import Block, Heading, Pairs


def card_blocks(cards: Iterable[Mapping[str, Any]]) -> tuple[Block, ...]:
    """Convert summary cards, given as the dictionaries from `ReadCard.to_dict`, to blocks."""
    return tuple(
        block for card in cards for block in (Heading(str(card["file"])), Pairs(card_rows(card)))
    )
