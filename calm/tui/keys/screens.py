"""Keys of the other screens and of what is put over them: water, text, forms, questions."""

from __future__ import annotations

from calm.tui.keys.action import Action

SCREENS: tuple[Action, ...] = (
    # the water
    Action("water", "next_environment", "f5", "environment", "The next environment.", 3),
    Action("water", "new_environment", "f6,ctrl+n", "new environment", "Add a named one.", 4),
    Action("water", "drop_environment", "f7", "drop it", "Remove the named environment."),
    Action("water", "preset", "ctrl+t", "presets", "Typical currents to start from.", 2),
    Action("water", "load_current", "ctrl+o", "read a file", "A current from CSV or NetCDF.", 1),
    Action("water", "app.focus_next", "down", "next", "To what is below.", palette=False),
    Action("water", "app.focus_previous", "up", "last", "To what is above.", palette=False),
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
        palette=False,
    ),
    Action(
        "grid",
        "move_row(1)",
        "down",
        "down",
        "To the row below; from the last one on to what follows.",
        palette=False,
    ),
    Action(
        "grid", "move_cell(1)", "tab", "next cell", "To the next value of the table.", palette=False
    ),
    Action("grid", "move_cell(-1)", "shift+tab", "last cell", "To the one before.", palette=False),
    Action("grid", "move_column(-1)", "left", "left", "To the left.", palette=False),
    Action("grid", "move_column(1)", "right", "right", "To the right.", palette=False),
    Action(
        "grid",
        "edit",
        "enter,f2",
        "edit",
        "Edit the number; typing begins at once.",
        0,
        palette=False,
    ),
    Action("grid", "add_row(1)", "a,insert", "add row", "Add a row below.", 1, palette=False),
    Action("grid", "add_row(0)", "A", "add above", "Add a row above.", palette=False),
    Action(
        "grid", "drop_row", "delete,backspace", "delete row", "Delete the row.", 2, palette=False
    ),
    # the text
    Action("text", "app.save", "ctrl+s", "save", "Save the file as it stands.", 1),
    Action("text", "find", "ctrl+f", "find", "Find words in the text.", 4),
    Action("text", "find_next", "f3,ctrl+g", "find next", "To where they are next.", 5),
    Action("text", "next_problem", "f8", "next mistake", "To the next mistake.", 2),
    Action("text", "back", "escape", "to the line", "To the line, once the text can be read.", 0),
    Action("text", "app.help", "f1", "help", "All keys.", 3),
    Action("area", "end(-1)", "ctrl+home", "top", "To the beginning of the text.", palette=False),
    Action("area", "end(1)", "ctrl+end", "bottom", "To the end of the text.", palette=False),
    Action("area", "indent", "tab", "indent", "Blanks to the next even column.", palette=False),
    # a component of one's own
    Action("form", "accept", "ctrl+s", "keep it", "Write the component into the file.", 0),
    Action("form", "cancel", "escape", "leave", "Leave without it.", 1),
    Action("form", "app.help", "f1", "help", "All keys.", 2),
    Action("form", "app.focus_next", "down", "next", "To the next figure.", palette=False),
    Action("form", "app.focus_previous", "up", "last", "To the one before.", palette=False),
    # what is put over a screen, or beside a name
    Action("choice", "turn(-1)", "left", "last", "The word before.", palette=False),
    Action("choice", "turn(1)", "right,space", "next", "The next word.", palette=False),
    Action("choice", "app.focus_next", "enter", "go on", "To what is below.", palette=False),
    Action(
        "given",
        "take",
        "enter",
        "take it",
        "Choose the form shown, and go on.",
        palette=False,
    ),
    Action("sheet", "take", "ctrl+s", "done", "Accept all values.", palette=False),
    Action("sheet", "leave", "escape", "leave", "Leave everything as it was.", palette=False),
    Action("sheet", "app.focus_next", "down", "next", "To the next value.", palette=False),
    Action("sheet", "app.focus_previous", "up", "last", "To the one before.", palette=False),
    Action(
        "question", "answer('')", "escape", "go back", "Go back, where possible.", palette=False
    ),
    Action(
        "help", "dismiss", "escape,q,enter,question_mark,f1", "close", "Close it.", palette=False
    ),
)
