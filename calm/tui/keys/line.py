"""Keys of the line: its rows, its verdict, a value in place, the catalogue beside it."""

from __future__ import annotations

from calm.tui.keys.builder import Action

LINE: tuple[Action, ...] = (
    # the line
    Action(
        "line",
        "edit",
        "enter,f2",
        "edit",
        "Edit the value under the cursor in place; on the component, choose another one.",
        1,
    ),
    Action("line", "add(1)", "a,insert", "add", "Add a piece below, from the catalogue.", 0),
    Action("line", "add(0)", "A", "add above", "Add a piece above."),
    Action("line", "clamp", "i", "clamp on", "Clamp an instrument on this piece.", 5),
    Action("line", "duplicate", "d", "duplicate", "Repeat the piece, or those marked, below.", 6),
    Action("line", "delete", "delete,backspace", "delete", "Delete the piece, or those marked.", 7),
    Action(
        "line", "move_piece(-1)", "alt+up,ctrl+up,K", "move up", "Move the piece up the line.", 8
    ),
    Action("line", "move_piece(1)", "alt+down,ctrl+down,J", "move down", "Move it down the line."),
    Action("line", "mark(0)", "space", "mark", "Mark the piece, or remove its mark."),
    Action("line", "mark(-1)", "shift+up", "mark up", "Mark it and go up.", palette=False),
    Action("line", "mark(1)", "shift+down", "mark down", "Mark it and go down.", palette=False),
    Action("line", "mark_all", "ctrl+a", "mark all", "Mark every piece."),
    Action("line", "cut", "x,ctrl+x", "cut", "Cut the piece, or those marked."),
    Action("line", "copy", "c,ctrl+c", "copy", "Copy them."),
    Action("line", "paste(1)", "v,ctrl+v", "paste", "Paste below the cursor."),
    Action("line", "paste(0)", "V", "paste above", "Paste above the cursor."),
    Action(
        "line", "edit_column('length')", "l", "length", "Edit its length, or where it is clamped."
    ),
    Action("line", "edit_column('label')", "n", "label", "Edit its label."),
    Action("line", "edit_column('count')", "equals_sign,asterisk", "count", "Edit its count."),
    Action(
        "line",
        "assemble",
        "k",
        "assembly",
        "Make the marked pieces an assembly of the file, to be used again under one name.",
    ),
    Action(
        "line",
        "change_component",
        "O",
        "change component",
        "Change the component of the row, one of the file's own, in its form.",
    ),
    Action(
        "line",
        "equipment",
        "N",
        "serial number",
        "Serial number, calibration, sampling, battery and termination of the row.",
    ),
    Action(
        "line",
        "next_finding",
        "f8,g",
        "next finding",
        "To the next row with the most serious finding; the last line of the screen shows it.",
    ),
    Action("line", "why", "y", "why", "All findings of this row, with remedies."),
    Action("line", "replace", "r", "replace", "Use another component in its place."),
    Action("line", "move_cursor(-1)", "up", "up", "To the row above.", palette=False),
    Action("line", "move_cursor(1)", "down", "down", "To the row below.", palette=False),
    Action("line", "move_page(-1)", "pageup", "page up", "A page up.", palette=False),
    Action("line", "move_page(1)", "pagedown", "page down", "A page down.", palette=False),
    Action("line", "move_to_end(-1)", "home", "top", "To the top of the line.", palette=False),
    Action("line", "move_to_end(1)", "end", "bottom", "To the bottom.", palette=False),
    Action("line", "move_column(-1)", "left", "left", "To the column on the left.", palette=False),
    Action("line", "move_column(1)", "right", "right", "To the one on the right.", palette=False),
    Action(
        "line",
        "back",
        "escape",
        "back",
        "Back to the line of the verdict that led here.",
        palette=False,
    ),
    # the verdict
    Action(
        "verdict", "move(-1)", "up", "up", "To the line above that leads to a row.", palette=False
    ),
    Action("verdict", "move(1)", "down", "down", "To the one below.", palette=False),
    Action(
        "verdict",
        "go",
        "enter",
        "its row",
        "To the row it is about; Esc leads back.",
        0,
        palette=False,
    ),
    Action("verdict", "leave", "escape", "line", "To the line.", 1, palette=False),
    # a value in place
    Action("cell", "done", "enter", "done", "Accept the value.", 0, palette=False),
    Action(
        "cell",
        "done('edit next')",
        "tab",
        "next",
        "Accept it and edit the next value.",
        1,
        palette=False,
    ),
    Action("cell", "done('up')", "up", "take, up", "Accept it and go up.", palette=False),
    Action("cell", "done('down')", "down", "take, down", "Accept it and go down.", palette=False),
    Action(
        "cell",
        "right",
        "right",
        "take, right",
        "At the end of the text: accept it and go to the right.",
        palette=False,
    ),
    Action("cell", "abandon", "escape", "leave it", "Leave the value as it was.", 2, palette=False),
    # the catalogue
    Action("catalogue", "choose(-1)", "up", "up", "To the one above.", palette=False),
    Action("catalogue", "choose(1)", "down", "down", "To the one below.", palette=False),
    Action("catalogue", "choose(-10)", "pageup", "page up", "Ten up.", palette=False),
    Action("catalogue", "choose(10)", "pagedown", "page down", "Ten down.", palette=False),
    Action(
        "catalogue",
        "sort",
        "f4",
        "sort",
        "Sort by net force, loads, depth rating, drag or mass.",
        1,
        palette=False,
    ),
    Action(
        "catalogue",
        "mark",
        "f3",
        "favourite",
        "Make it a favourite, or not; favourites come first, in every file.",
        2,
        palette=False,
    ),
    Action("catalogue", "take", "enter", "insert", "Put it into the line.", 0, palette=False),
    Action("catalogue", "close", "escape", "close", "Back to the line.", 3, palette=False),
)
