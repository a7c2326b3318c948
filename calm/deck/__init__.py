"""What goes to sea with a mooring: what hangs where, in which order, cut how, and how heavy."""

from calm.deck.model import Deck, deck_of

__all__ = ["Deck", "deck_of"]
