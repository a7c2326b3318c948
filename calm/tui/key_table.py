"""All actions of the builder: where their keys work, and the order of the help and the palette."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Place = Literal[
    "anywhere", "line", "verdict", "catalogue", "cell", "water", "grid", "choice", "given", "text",
    "area", "form", "sheet", "question", "help",
]  # fmt: skip
"""Where the keys of an action work: what has the focus, or the screen it is on."""


@dataclass(frozen=True)
class Action:
    """A verb.

    Attributes
    ----------
    place : where its keys work
    name : of the method, without ``action_``, with its arguments
    keys : as textual writes them, separated by commas; the first is the one that is shown
    title : two or three words, for the palette and the line of keys
    meaning : a sentence for the help
    hint : its rank in the line of keys, 0 the first; None where it is not among them
    palette : whether the command palette offers it, where it is of the line or works anywhere
    """

    place: Place
    name: str
    keys: str
    title: str
    meaning: str
    hint: int | None = None
    palette: bool = True


BUILDER: tuple[Action, ...] = (
    # anywhere
    Action("anywhere", "undo", "u", "undo", "Undo the last change, as often as there is one.", 3),
    Action(
        "anywhere",
        "suspend",
        "ctrl+z",
        "suspend",
        "Suspend to the shell, `fg` returns; while a value is edited, and in a browser: undo.",
    ),
    Action("anywhere", "redo", "U,ctrl+y", "redo", "Redo what was undone."),
    Action("anywhere", "water", "w", "water", "Depth, density, current, wind; environments.", 4),
    Action(
        "anywhere", "next_environment", "e", "environment", "Show the line in the next environment."
    ),
    Action(
        "anywhere",
        "advise",
        "p",
        "advice",
        "Changes that correct a finding or meet a target; shown before you accept them.",
        10,
    ),
    Action("anywhere", "compare", "D", "compare", "What has changed since the file was saved."),
    Action(
        "anywhere",
        "compare_file",
        "C",
        "compare with",
        "Another file beside this one: differences, and its line in the pictures.",
    ),
    Action(
        "anywhere",
        "overlay",
        "0",
        "overlay",
        "Draw the line in all its environments, in still water dotted; or in its own alone.",
    ),
    Action(
        "anywhere",
        "figures",
        "f",
        "missing figures",
        "Fill in the figures that are not known, piece by piece, with their source.",
    ),
    Action(
        "anywhere",
        "verdict",
        "G",
        "verdict",
        "The verdict line by line: Enter goes to the row that a line is about, Esc back.",
    ),
    Action("anywhere", "search", "slash", "catalogue", "Search the catalogue."),
    Action("anywhere", "define", "o", "own component", "Define a component of your own."),
    Action("anywhere", "picture('elevation')", "1", "elevation", "The line seen from the side."),
    Action("anywhere", "picture('plan')", "2", "plan", "The line seen from above."),
    Action("anywhere", "picture('tension')", "3", "tension", "Tension along the line."),
    Action("anywhere", "picture('schematic')", "4", "schematic", "The parts, not to scale."),
    Action("anywhere", "zoom", "z", "zoom", "Give the picture the whole screen, or take it back."),
    Action("anywhere", "mooring", "m", "name, place", "Name, description and position."),
    Action(
        "anywhere",
        "document",
        "M",
        "document",
        "Number, revision and what it changed, author, ship and cruise, for the title block.",
    ),
    Action(
        "anywhere",
        "deployed",
        "L",
        "as deployed",
        "Date, position and depth of the deployment; of the row its number, length, remark, codes.",
    ),
    Action(
        "anywhere",
        "tow",
        "T",
        "tow",
        "Speed and course of a tow; makes the line one, which hangs from a ship.",
    ),
    Action(
        "anywhere",
        "begin",
        "b",
        "begin",
        "Begin an empty line with a mooring: deep, shelf, ADCP, taut or slack surface; a tow.",
    ),
    Action(
        "anywhere",
        "papers",
        "P",
        "papers",
        "Bill and totals; write the report of the check, or the sheets for the deck.",
    ),
    Action(
        "anywhere", "history", "h", "history", "History of changes, and back to before any of them."
    ),
    Action("anywhere", "text", "t", "text", "The file as text, with its mistakes."),
    Action("anywhere", "app.save", "ctrl+s,s", "save", "Save the file.", 9),
    Action("anywhere", "app.save_as", "S", "save as", "Save it under another name."),
    Action("anywhere", "app.help", "question_mark,f1", "help", "All keys.", 2),
    Action(
        "anywhere",
        "app.command_palette",
        "ctrl+p,colon",
        "commands",
        "Find any of these by its name.",
        palette=False,
    ),
    Action("anywhere", "app.repaint", "ctrl+l", "repaint", "Redraw the whole screen."),
    Action("anywhere", "app.quit", "q,ctrl+q", "quit", "Leave; unsaved work is asked about.", 11),
)


SCREENS: tuple[Action, ...] = (
    # the water
    Action("water", "next_environment", "f5", "environment", "The next environment.", 3),
    Action("water", "new_environment", "f6,ctrl+n", "new environment", "Add a named one.", 4),
    Action("water", "drop_environment", "f7", "drop it", "Remove the named environment."),
    Action("water", "preset", "ctrl+t", "presets", "Typical currents to start from.", 2),
    Action("water", "load_current", "ctrl+o", "read a file", "A current from CSV or NetCDF.", 1),
    Action("water", "app.focus_next", "down", "next", "To what is below."),
    Action("water", "app.focus_previous", "up", "last", "To what is above."),
    Action("water", "undo", "ctrl+z", "undo", "Undo the last change."),
    Action("water", "redo", "ctrl+y", "redo", "Do it again."),
    Action("water", "app.save", "ctrl+s", "save", "Save the file."),
    Action("water", "app.help", "f1", "help", "All keys.", 5),
    Action("water", "back", "escape", "back", "Back to the line.", 0),
    Action(
        "grid",
        "move_row(-1)",
        "up",
        "up",
        "To the row above; from the first one to what is before.",
    ),
    Action(
        "grid",
        "move_row(1)",
        "down",
        "down",
        "To the row below; from the last one on to what follows.",
    ),
    Action("grid", "move_cell(1)", "tab", "next cell", "To the next value of the table."),
    Action("grid", "move_cell(-1)", "shift+tab", "last cell", "To the one before."),
    Action("grid", "move_column(-1)", "left", "left", "To the left."),
    Action("grid", "move_column(1)", "right", "right", "To the right."),
    Action("grid", "edit", "enter,f2", "edit", "Edit the number; typing begins at once.", 0),
    Action("grid", "add_row(1)", "a,insert", "add row", "Add a row below.", 1),
    Action("grid", "add_row(0)", "A", "add above", "Add a row above."),
    Action("grid", "drop_row", "delete,backspace", "delete row", "Delete the row.", 2),
    # the text
    Action("text", "app.save", "ctrl+s", "save", "Save the file as it stands.", 1),
    Action("text", "find", "ctrl+f", "find", "Find words in the text.", 4),
    Action("text", "find_next", "f3,ctrl+g", "find next", "To where they are next.", 5),
    Action("text", "next_problem", "f8", "next mistake", "To the next mistake.", 2),
    Action("text", "back", "escape", "to the line", "To the line, once the text can be read.", 0),
    Action("text", "app.help", "f1", "help", "All keys.", 3),
    Action("area", "end(-1)", "ctrl+home", "top", "To the beginning of the text."),
    Action("area", "end(1)", "ctrl+end", "bottom", "To the end of the text."),
    Action("area", "indent", "tab", "indent", "Blanks to the next even column."),
    # a component of one's own
    Action("form", "accept", "ctrl+s", "keep it", "Write the component into the file.", 0),
    Action("form", "cancel", "escape", "leave", "Leave without it.", 1),
    Action("form", "app.help", "f1", "help", "All keys.", 2),
    Action("form", "app.focus_next", "down", "next", "To the next figure."),
    Action("form", "app.focus_previous", "up", "last", "To the one before."),
    # what is put over a screen, or beside a name
    Action("choice", "turn(-1)", "left", "last", "The word before."),
    Action("choice", "turn(1)", "right,space", "next", "The next word."),
    Action("choice", "app.focus_next", "enter", "go on", "To what is below."),
    Action("given", "take", "enter", "take it", "Choose the form shown, and go on."),
    Action("sheet", "take", "ctrl+s", "done", "Accept all values."),
    Action("sheet", "leave", "escape", "leave", "Leave everything as it was."),
    Action("sheet", "app.focus_next", "down", "next", "To the next value."),
    Action("sheet", "app.focus_previous", "up", "last", "To the one before."),
    Action("question", "answer('')", "escape", "go back", "Go back, where possible."),
    Action("help", "dismiss", "escape,q,enter,question_mark,f1", "close", "Close it."),
)


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
    Action("verdict", "move(-1)", "up", "up", "To the line above that leads to a row."),
    Action("verdict", "move(1)", "down", "down", "To the one below."),
    Action("verdict", "go", "enter", "its row", "To the row it is about; Esc leads back.", 0),
    Action("verdict", "leave", "escape", "line", "To the line.", 1),
    # a value in place
    Action("cell", "done", "enter", "done", "Accept the value.", 0),
    Action("cell", "done('edit next')", "tab", "next", "Accept it and edit the next value.", 1),
    Action("cell", "done('up')", "up", "take, up", "Accept it and go up."),
    Action("cell", "done('down')", "down", "take, down", "Accept it and go down."),
    Action(
        "cell",
        "right",
        "right",
        "take, right",
        "At the end of the text: accept it and go to the right.",
    ),
    Action("cell", "abandon", "escape", "leave it", "Leave the value as it was.", 2),
    # the catalogue
    Action("catalogue", "choose(-1)", "up", "up", "To the one above."),
    Action("catalogue", "choose(1)", "down", "down", "To the one below."),
    Action("catalogue", "choose(-10)", "pageup", "page up", "Ten up."),
    Action("catalogue", "choose(10)", "pagedown", "page down", "Ten down."),
    Action(
        "catalogue",
        "sort",
        "f4",
        "sort",
        "Sort by net force, loads, depth rating, drag or mass.",
        1,
    ),
    Action(
        "catalogue",
        "mark",
        "f3",
        "favourite",
        "Make it a favourite, or not; favourites come first, in every file.",
        2,
    ),
    Action("catalogue", "take", "enter", "insert", "Put it into the line.", 0),
    Action("catalogue", "close", "escape", "close", "Back to the line.", 3),
)


ACTIONS: tuple[Action, ...] = (*LINE, *BUILDER, *SCREENS)
