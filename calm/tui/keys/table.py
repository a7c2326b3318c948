"""All actions, in the order in which the help and the palette have them."""

from __future__ import annotations

from calm.tui.keys.builder import BUILDER, SCREENS, Action
from calm.tui.keys.line import LINE

ACTIONS: tuple[Action, ...] = (*LINE, *BUILDER, *SCREENS)
