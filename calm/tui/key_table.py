"""All actions of the builder with their keys.

Key bindings, key bar, help and command palette are made from this table.
"""

from collections.abc import Iterable
from dataclasses import dataclass

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text
from textual.binding import Binding, BindingType
from textual.containers import ScrollableContainer
from textual.keys import key_to_character
from textual.screen import Screen
from textual.widgets import Input, TextArea

from calm.checks.finding import State


@dataclass(frozen=True)
class Action:
    """An action of the builder.

    Attributes
    ----------
    place : widget or screen in which the keys work
    name : name of the method, without ``action_``, with its arguments
    keys : keys in Textual's notation, separated by commas; the first is displayed
    title, meaning : short name, and sentence for the help
    hint : rank in the key bar, from 0; None if not in the key bar
    palette : whether the command palette may list the action
    """

    place: str
    name: str
    keys: str
    title: str
    meaning: str
    hint: int | None = None
    palette: bool = True


_TABLE = """
[line] The line
edit | enter,f2 | edit | 1 | Edit the value under the cursor in place; on the component, choose
  another component.
search('below') | a,insert | add | 0 | Add a piece below, from the catalogue.
search('above') | A | add above |  | Add a piece above.
search('clamp') | i | clamp on | 5 | Clamp an instrument onto this piece.
duplicate | d | duplicate | 6 | Duplicate the piece, or the marked pieces, below.
delete | delete,backspace | delete | 7 | Delete the piece, or the marked pieces.
move_piece(-1) | alt+up,ctrl+up,K | move up | 8 | Move the piece up the line.
move_piece(1) | alt+down,ctrl+down,J | move down |  | Move the piece down the line.
mark(0) | space | mark |  | Mark the piece, or remove its mark.
mark(-1) | shift+up | mark up | - | Mark the piece and go up.
mark(1) | shift+down | mark down | - | Mark the piece and go down.
mark_all | ctrl+a | mark all |  | Mark every piece.
cut | x,ctrl+x | cut |  | Cut the piece, or the marked pieces.
copy | c,ctrl+c | copy |  | Copy the piece, or the marked pieces.
paste(1) | v,ctrl+v | paste |  | Paste below the cursor.
paste(0) | V | paste above |  | Paste above the cursor.
edit_column('length') | l | length |  | Edit the length of a piece, or the position of a clamp.
edit_column('label') | n | label |  | Edit the label.
edit_column('count') | equals_sign,asterisk | count |  | Edit the count.
screen.change_component | O | change component |  | Edit the component of the row in a form, if the
  file defines it.
equipment | N | serial number |  | Edit serial number, calibration, sampling, battery, termination
  and planned depth of the row.
find | slash | find | 12 | Find words in the line: id, label, serial number, maker.
find_next(1) | greater_than_sign,f3 | find next |  | Go to the next match.
find_next(-1) | less_than_sign | find previous |  | Go to the previous match.
weakest | percent_sign | weakest |  | Go to the piece with the highest utilisation of strength.
column | number_sign | fill column |  | Fill in serial numbers, lengths, labels or codes of the
  marked rows, or of all rows with the component under the cursor; a list can be pasted.
repeat | plus | repeat |  | Add several copies of the piece, or of the marked pieces.
next_finding | f8,g | next finding |  | Go to the next row with a finding of the most serious state;
  the last line of the screen shows the finding.
why | y | why |  | Show all findings of this row, with remedies.
search('replace') | r | replace |  | Replace the component.
move_cursor(-1) | up | up | - | Go to the row above.
move_cursor(1) | down | down | - | Go to the row below.
move_page(-1) | pageup | page up | - | Go a page up.
move_page(1) | pagedown | page down | - | Go a page down.
move_to_end(-1) | home | top | - | Go to the top of the line.
move_to_end(1) | end | bottom | - | Go to the bottom of the line.
move_column(-1) | left | left | - | Go to the column on the left.
move_column(1) | right | right | - | Go to the column on the right.
screen.back | escape | back | - | Return to the line of the verdict that led here.
[anywhere] On the main screen
undo | u | undo | 3 | Undo the last change; repeat to undo earlier changes.
suspend | ctrl+z | suspend |  | Suspend CALM (`fg` in the shell resumes it); while a value is
  edited, or in a browser, undo.
redo | U,ctrl+y | redo |  | Redo the last undone change.
water | w | water | 4 | Edit depth, density, current and wind of the environments.
next_environment | e | environment |  | Show the line in the next environment.
advise | p | advice | 10 | Propose changes that correct a finding or meet a target; they are shown
  before you accept them.
compare | ctrl+d | compare |  | Show the changes since the file was saved.
figures | f | missing values |  | Enter missing component values with their source.
verdict | f6 | verdict |  | Read the verdict line by line: Enter goes to the row of a line, Esc
  returns.
search('below') | f7 | catalogue |  | Browse the catalogue.
define | o | own component |  | Define a component of your own.
picture('elevation') | 1 | elevation |  | Show the line from the side.
picture('plan') | 2 | plan |  | Show the line from above.
picture('tension') | 3 | tension |  | Show the tension along the line.
picture('schematic') | 4 | schematic |  | Show the parts, not to scale.
zoom | z | zoom |  | Show the picture on the whole screen, or restore the screen.
sheet('mooring') | m | name, position |  | Edit name, description and position.
sheet('document') | M | document |  | Edit number, revisions, author, ship and cruise for the title
  block.
sheet('deployed') | at | as deployed |  | Edit date, position and depth of the deployment, and
  serial number, length, remark and release codes of the row.
sheet('tow') | T | tow |  | Edit speed and course of a tow, or turn a mooring into a tow.
settings | comma | settings |  | Edit solver, limits of the check, uncertainty and units of output.
begin | b | begin |  | Start an empty line from a template: deep, shelf, ADCP, taut or slack surface
  mooring, or tow.
documents | f9 | documents |  | Show the bill of material; write the report of the check or the deck
  sheets.
history | h | history |  | Show the history of changes, and go back to an earlier state.
text | t | text |  | Edit the file as text, with its mistakes.
app.save | ctrl+s,s | save | 9 | Save the file.
app.save_as | S | save as |  | Save the file under another name.
app.help | question_mark,f1 | help | 2 | Show all keys.
app.command_palette | ctrl+p,colon | commands | - | Find any of these actions by name.
app.repaint | ctrl+l | repaint |  | Redraw the whole screen.
app.quit | q,ctrl+q | quit | 11 | Quit; CALM asks about unsaved changes.
[verdict] The verdict, line by line
move(-1) | up | up |  | Go to the line above that leads to a row.
move(1) | down | down |  | Go to the line below that leads to a row.
go | enter | its row | 0 | Go to the row of this line; Esc returns.
leave | escape | line | 1 | Return to the line.
[cell] While a value is edited in place
done | enter | done | 0 | Accept the value.
done('edit next') | tab | next | 1 | Accept the value and edit the next one.
done('up') | up | accept, up |  | Accept the value and go up.
done('down') | down | accept, down |  | Accept the value and go down.
right | right | accept, right |  | At the end of the text: accept the value and go to the right.
abandon | escape | cancel | 2 | Cancel editing.
[catalogue] The catalogue
choose(-1) | up | up |  | Go to the component above.
choose(1) | down | down |  | Go to the component below.
choose(-10) | pageup | page up |  | Go up by ten components.
choose(10) | pagedown | page down |  | Go down by ten components.
sort | f4 | sort | 1 | Sort by net force, loads, depth rating, drag or mass.
mark | f3 | favourite | 2 | Add the component to the favourites, or remove it; favourites are
  listed first, in every file.
take | enter | insert | 0 | Add the component to the line.
close | escape | close | 3 | Return to the line.
[water] The water
next_environment | f5 | environment | 3 | Go to the next environment.
new_environment | f6,ctrl+n | new environment | 4 | Add a named environment.
drop_environment | f7 | remove |  | Remove the named environment.
preset | ctrl+t | presets | 2 | Choose a typical current to start from.
load_current | ctrl+o | read a file | 1 | Read a current from CSV or NetCDF.
app.focus_next | down | next |  | Go to the next field.
app.focus_previous | up | previous |  | Go to the previous field.
undo | ctrl+z | undo |  | Undo the last change.
redo | ctrl+y | redo |  | Redo the last undone change.
app.save | ctrl+s | save |  | Save the file.
app.help | f1 | help | 5 | Show all keys.
back | escape | back | 0 | Return to the line.
[grid] A table of the water
move_row(-1) | up | up |  | Go to the row above; from the first row to the previous field.
move_row(1) | down | down |  | Go to the row below; from the last row to the next field.
move_cell(1) | tab | next cell |  | Go to the next value of the table.
move_cell(-1) | shift+tab | previous cell |  | Go to the previous value of the table.
move_column(-1) | left | left |  | Go to the column on the left.
move_column(1) | right | right |  | Go to the column on the right.
edit | enter,f2 | edit | 0 | Edit the value; typing a digit also starts editing.
add_row(1) | a,insert | add row | 1 | Add a row below.
add_row(0) | A | add above |  | Add a row above.
drop_row | delete,backspace | delete row | 2 | Delete the row.
[choice] A choice between arrows
turn(-1) | left | previous |  | Show the previous word.
turn(1) | right,space | next |  | Show the next word.
app.focus_next | enter | go on |  | Go to the next field.
[given] The form of density or current
take | enter | accept |  | Choose the form shown, and go to the next field.
[text] The file as text
app.save | ctrl+s | save | 1 | Save the file.
find | ctrl+f | find | 4 | Find words in the text.
find_next | f3,ctrl+g | find next | 5 | Go to the next match.
next_problem | f8 | next mistake | 2 | Go to the next mistake.
back | escape | to the line | 0 | Return to the line, once the text is valid.
app.help | f1 | help | 3 | Show all keys.
[area] While the text is typed
end(-1) | ctrl+home | top |  | Go to the beginning of the text.
end(1) | ctrl+end | bottom |  | Go to the end of the text.
indent | tab | indent |  | Insert blanks up to the next even column.
[form] A component of your own
take | ctrl+s | save | 0 | Write the component into the file.
leave | escape | cancel | 1 | Close the form without changes.
app.help | f1 | help | 2 | Show all keys.
app.focus_next | down | next |  | Go to the next field.
app.focus_previous | up | previous |  | Go to the previous field.
[sheet] A sheet of several values
take | ctrl+s | done |  | Accept all values.
leave | escape | cancel |  | Discard all changes.
app.focus_next | down | next |  | Go to the next field.
app.focus_previous | up | previous |  | Go to the previous field.
[question] A question, answered by the letter in front of each answer
move(-1) | up | up |  | Go to the answer above.
move(1) | down | down |  | Go to the answer below.
give | enter | choose |  | Choose the marked answer.
leave | escape | go back |  | Go back, where possible.
[help] This help
dismiss | escape,q,enter,question_mark,f1 | close |  | Close the help.
"""
"""Actions of each part of the builder, under the heading of that part in the help.

Each row is: name | keys | title | rank in the key bar | meaning. Lines that begin with a blank
continue the meaning. If the rank is ``-``, the command palette does not list the action.
"""


def _action(place: str, row: str) -> Action:
    name, keys, title, rank, meaning = row.split(" | ")
    hint = int(rank) if rank.isdecimal() else None
    return Action(place, name, keys, title, meaning, hint, palette=rank != "-")


PLACES: dict[str, str] = {}
"""Help headings by part of the builder, in order."""
ACTIONS: dict[str, list[Action]] = {}
"""Actions by part of the builder, in order."""

for _section in _TABLE.strip("\n[").replace("\n  ", " ").split("\n["):
    _head, *_rows = _section.splitlines()
    _place, PLACES[_place] = _head.split("] ")
    ACTIONS[_place] = [_action(_place, _row) for _row in _rows]


_ARROWS = {"up": "↑", "down": "↓", "left": "←", "right": "→"}
_SHORT = {"escape": "Esc", "delete": "Del", "insert": "Ins", "pageup": "PgUp", "pagedown": "PgDn"}
_KEYS = {**_ARROWS, **_SHORT, "slash": "/", "space": "Space"}


def shown_key(key: str) -> str:
    """Convert a key name to its usual form: ``ctrl+s`` → ``Ctrl+S``, ``question_mark`` → ``?``."""
    *held, last = key.split("+")
    if len(last) == 1:
        last = last.upper() if held else last
    else:
        sign = _KEYS.get(last) or key_to_character(last) or ""
        last = sign if sign and sign.isprintable() else last.capitalize()
    return "+".join([*(part.capitalize() for part in held), last])


def shown_keys(keys: str) -> str:
    """Convert comma-separated key names to their usual form."""
    return "  ".join(map(shown_key, keys.split(",")))


def bindings(place: str) -> list[BindingType]:
    """Return the key bindings for a widget or screen, which must define the actions as methods."""
    return [Binding(each.keys, each.name, each.title, show=False) for each in ACTIONS[place]]


def hints(place: str) -> list[Action]:
    """Return the actions shown in the key bar for a focused widget, the most used first."""
    places = ("line", "anywhere") if place == "line" else (place,)
    own = [each for where in places for each in ACTIONS[where] if each.hint is not None]
    return sorted(own, key=lambda action: action.hint or 0)


_SIGNS = "Signs: " + ", ".join(f"{state.sign} {state}" for state in reversed(State))
_GROUND = (
    "Every change is solved and judged at once; until then the previous values are dimmed. "
    " A number without a unit takes the unit shown. With the mouse, click a cell to go "
    "there, and click again to edit it."
)
_OF_TEXTUAL: dict[str, Iterable[BindingType]] = {
    "On every screen, with Ctrl+P and Ctrl+Q": Screen.BINDINGS,
    "While a value is typed": Input.BINDINGS,
    "In addition, while text is typed": TextArea.BINDINGS,
    "Pictures, verdict and texts longer than the screen": ScrollableContainer.BINDINGS,
}
"""Keys that Textual's widgets define, with their descriptions."""


def all_keys() -> RenderableType:
    """Return tables of all keys, one for each part of the builder."""
    listed = {
        title: [(action.keys, action.meaning) for action in ACTIONS[place]]
        for place, title in PLACES.items()
    }
    for title, inherited in _OF_TEXTUAL.items():
        bound = [each for each in inherited if isinstance(each, Binding)]
        listed[title] = [(each.key, f"{each.description.capitalize()}.") for each in bound]
    parts: list[RenderableType] = [Text("Keys", style="bold"), Text(_GROUND), Text(_SIGNS)]
    for title, rows in listed.items():
        table = Table.grid(padding=(0, 2, 0, 0))
        table.add_column(width=20, overflow="fold")
        table.add_column(overflow="fold")
        for keys, meaning in rows:
            table.add_row(Text(shown_keys(keys), style="bold"), Text(meaning))
        parts += [Text(f"\n{title}", style="bold underline"), table]
    return Group(*parts)
