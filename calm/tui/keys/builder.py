"""Keys that work anywhere on the first screen."""

from __future__ import annotations

from calm.tui.keys.action import Action

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
        "anywhere",
        "next_environment",
        "e",
        "environment",
        "Show the line in the next environment.",
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
