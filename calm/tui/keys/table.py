"""All actions, in the order in which the help and the palette have them."""

from __future__ import annotations

from calm.tui.keys.action import Action
from calm.tui.keys.builder import BUILDER
from calm.tui.keys.line import LINE
from calm.tui.keys.screens import SCREENS

ACTIONS: tuple[Action, ...] = (*LINE, *BUILDER, *SCREENS)
