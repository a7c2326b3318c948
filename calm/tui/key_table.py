"""All actions of the builder and their keys: where they work, as hints, in help and palette."""

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
    """A verb.

    Attributes
    ----------
    place : where its keys work: what has the focus, or the screen it is on
    name : of the method, without ``action_``, with its arguments
    keys : as textual writes them, separated by commas; the first is the one that is shown
    title : two or three words, for the palette and the line of keys
    meaning : a sentence for the help
    hint : its rank in the line of keys, 0 the first; None where it is not among them
    palette : whether the command palette offers it, where it is of the line or works anywhere
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
  another one.
search('below') | a,insert | add | 0 | Add a piece below, from the catalogue.
search('above') | A | add above |  | Add a piece above.
search('clamp') | i | clamp on | 5 | Clamp an instrument on this piece.
duplicate | d | duplicate | 6 | Repeat the piece, or those marked, below.
delete | delete,backspace | delete | 7 | Delete the piece, or those marked.
move_piece(-1) | alt+up,ctrl+up,K | move up | 8 | Move the piece up the line.
move_piece(1) | alt+down,ctrl+down,J | move down |  | Move it down the line.
mark(0) | space | mark |  | Mark the piece, or remove its mark.
mark(-1) | shift+up | mark up | - | Mark it and go up.
mark(1) | shift+down | mark down | - | Mark it and go down.
mark_all | ctrl+a | mark all |  | Mark every piece.
cut | x,ctrl+x | cut |  | Cut the piece, or those marked.
copy | c,ctrl+c | copy |  | Copy them.
paste(1) | v,ctrl+v | paste |  | Paste below the cursor.
paste(0) | V | paste above |  | Paste above the cursor.
edit_column('length') | l | length |  | Edit its length, or where it is clamped.
edit_column('label') | n | label |  | Edit its label.
edit_column('count') | equals_sign,asterisk | count |  | Edit its count.
screen.change_component | O | change component |  | Change the component of the row, one of the
  file's own, in its form.
equipment | N | serial number |  | Serial number, calibration, sampling, battery, termination
  and planned depth of the row.
find | slash | find | 12 | Find words in the line: id, label, serial number, maker.
find_next(1) | greater_than_sign,f3 | find next |  | To the next row that has them.
find_next(-1) | less_than_sign | find last |  | To the one before.
weakest | percent_sign | weakest |  | To the piece whose strength is used most.
column | number_sign | fill column |  | Serial numbers, lengths, labels or codes of the marked rows,
  or of all of the component under the cursor, one below the other or pasted.
repeat | plus | repeat |  | Repeat the piece, or those marked, as often as you say.
next_finding | f8,g | next finding |  | To the next row with the most serious finding; the last
  line of the screen shows it.
why | y | why |  | All findings of this row, with remedies.
search('replace') | r | replace |  | Use another component in its place.
move_cursor(-1) | up | up | - | To the row above.
move_cursor(1) | down | down | - | To the row below.
move_page(-1) | pageup | page up | - | A page up.
move_page(1) | pagedown | page down | - | A page down.
move_to_end(-1) | home | top | - | To the top of the line.
move_to_end(1) | end | bottom | - | To the bottom.
move_column(-1) | left | left | - | To the column on the left.
move_column(1) | right | right | - | To the one on the right.
screen.back | escape | back | - | Back to the line of the verdict that led here.
[anywhere] Anywhere on the first screen
undo | u | undo | 3 | Undo the last change, as often as there is one.
suspend | ctrl+z | suspend |  | Suspend to the shell, `fg` returns; while a value is edited, and
  in a browser: undo.
redo | U,ctrl+y | redo |  | Redo what was undone.
water | w | water | 4 | Depth, density, current, wind; environments.
next_environment | e | environment |  | Show the line in the next environment.
advise | p | advice | 10 | Changes that correct a finding or meet a target; shown before you
  accept them.
compare | ctrl+d | compare |  | What has changed since the file was saved.
figures | f | missing figures |  | Fill in the figures that are not known, piece by piece, with
  their source.
verdict | f6 | verdict |  | The verdict line by line: Enter goes to the row that a line is about,
  Esc back.
search('below') | f7 | catalogue |  | Browse the catalogue.
define | o | own component |  | Define a component of your own.
picture('elevation') | 1 | elevation |  | The line seen from the side.
picture('plan') | 2 | plan |  | The line seen from above.
picture('tension') | 3 | tension |  | Tension along the line.
picture('schematic') | 4 | schematic |  | The parts, not to scale.
zoom | z | zoom |  | Give the picture the whole screen, or take it back.
sheet('mooring') | m | name, place |  | Name, description and position.
sheet('document') | M | document |  | Number, revision and what it changed, author, ship and cruise,
  for the title block.
sheet('deployed') | at | as deployed |  | Date, position and depth of the deployment; of the row its
  number, length, remark, codes.
sheet('tow') | T | tow |  | Speed and course of a tow; makes the line one, which hangs from a ship.
settings | comma | settings |  | Solver, limits of the check, uncertainty and units of output.
begin | b | begin |  | Begin an empty line with a mooring: deep, shelf, ADCP, taut or slack
  surface; a tow.
papers | f9 | papers |  | Bill and totals; write the report of the check, or the sheets for the
  deck.
history | h | history |  | History of changes, and back to before any of them.
text | t | text |  | The file as text, with its mistakes.
app.save | ctrl+s,s | save | 9 | Save the file.
app.save_as | S | save as |  | Save it under another name.
app.help | question_mark,f1 | help | 2 | All keys.
app.command_palette | ctrl+p,colon | commands | - | Find any of these by its name.
app.repaint | ctrl+l | repaint |  | Redraw the whole screen.
app.quit | q,ctrl+q | quit | 11 | Leave; unsaved work is asked about.
[verdict] The verdict, line by line
move(-1) | up | up |  | To the line above that leads to a row.
move(1) | down | down |  | To the one below.
go | enter | its row | 0 | To the row it is about; Esc leads back.
leave | escape | line | 1 | To the line.
[cell] While a value is edited in place
done | enter | done | 0 | Accept the value.
done('edit next') | tab | next | 1 | Accept it and edit the next value.
done('up') | up | take, up |  | Accept it and go up.
done('down') | down | take, down |  | Accept it and go down.
right | right | take, right |  | At the end of the text: accept it and go to the right.
abandon | escape | leave it | 2 | Leave the value as it was.
[catalogue] The catalogue
choose(-1) | up | up |  | To the one above.
choose(1) | down | down |  | To the one below.
choose(-10) | pageup | page up |  | Ten up.
choose(10) | pagedown | page down |  | Ten down.
sort | f4 | sort | 1 | Sort by net force, loads, depth rating, drag or mass.
mark | f3 | favourite | 2 | Make it a favourite, or not; favourites come first, in every file.
take | enter | insert | 0 | Put it into the line.
close | escape | close | 3 | Back to the line.
[water] The water
next_environment | f5 | environment | 3 | The next environment.
new_environment | f6,ctrl+n | new environment | 4 | Add a named one.
drop_environment | f7 | drop it |  | Remove the named environment.
preset | ctrl+t | presets | 2 | Typical currents to start from.
load_current | ctrl+o | read a file | 1 | A current from CSV or NetCDF.
app.focus_next | down | next |  | To what is below.
app.focus_previous | up | last |  | To what is above.
undo | ctrl+z | undo |  | Undo the last change.
redo | ctrl+y | redo |  | Do it again.
app.save | ctrl+s | save |  | Save the file.
app.help | f1 | help | 5 | All keys.
back | escape | back | 0 | Back to the line.
[grid] A table of the water
move_row(-1) | up | up |  | To the row above; from the first one to what is before.
move_row(1) | down | down |  | To the row below; from the last one on to what follows.
move_cell(1) | tab | next cell |  | To the next value of the table.
move_cell(-1) | shift+tab | last cell |  | To the one before.
move_column(-1) | left | left |  | To the left.
move_column(1) | right | right |  | To the right.
edit | enter,f2 | edit | 0 | Edit the number; typing begins at once.
add_row(1) | a,insert | add row | 1 | Add a row below.
add_row(0) | A | add above |  | Add a row above.
drop_row | delete,backspace | delete row | 2 | Delete the row.
[choice] One of some words between arrows
turn(-1) | left | last |  | The word before.
turn(1) | right,space | next |  | The next word.
app.focus_next | enter | go on |  | To what is below.
[given] The form in which density or current is given
take | enter | take it |  | Choose the form shown, and go on.
[text] The file as text
app.save | ctrl+s | save | 1 | Save the file as it stands.
find | ctrl+f | find | 4 | Find words in the text.
find_next | f3,ctrl+g | find next | 5 | To where they are next.
next_problem | f8 | next mistake | 2 | To the next mistake.
back | escape | to the line | 0 | To the line, once the text can be read.
app.help | f1 | help | 3 | All keys.
[area] While the text is typed
end(-1) | ctrl+home | top |  | To the beginning of the text.
end(1) | ctrl+end | bottom |  | To the end of the text.
indent | tab | indent |  | Blanks to the next even column.
[form] A component of your own
take | ctrl+s | keep it | 0 | Write the component into the file.
leave | escape | leave | 1 | Leave without it.
app.help | f1 | help | 2 | All keys.
app.focus_next | down | next |  | To the next figure.
app.focus_previous | up | last |  | To the one before.
[sheet] Some values asked for together
take | ctrl+s | done |  | Accept all values.
leave | escape | leave |  | Leave everything as it was.
app.focus_next | down | next |  | To the next value.
app.focus_previous | up | last |  | To the one before.
[question] A question, answered by the letter in front of each answer
move(-1) | up | up |  | To the answer above.
move(1) | down | down |  | To the answer below.
give | enter | give |  | Give the answer that is marked, if one is.
leave | escape | go back |  | Go back, where possible.
[help] This help
dismiss | escape,q,enter,question_mark,f1 | close |  | Close it.
"""
"""Below its place, with the heading that this has in the help, each action: name | keys | title |
rank of its hint | meaning, which may go on in lines that begin with a blank. A ``-`` in place of
the rank keeps it out of the palette."""


def _action(place: str, row: str) -> Action:
    name, keys, title, rank, meaning = row.split(" | ")
    hint = int(rank) if rank.isdecimal() else None
    return Action(place, name, keys, title, meaning, hint, palette=rank != "-")


PLACES: dict[str, str] = {}
"""The headings of the help by their places, in its order."""
ACTIONS: dict[str, list[Action]] = {}
"""The actions of each place, in order."""

for _section in _TABLE.strip("\n[").replace("\n  ", " ").split("\n["):
    _head, *_rows = _section.splitlines()
    _place, PLACES[_place] = _head.split("] ")
    ACTIONS[_place] = [_action(_place, _row) for _row in _rows]


_ARROWS = {"up": "↑", "down": "↓", "left": "←", "right": "→"}
_SHORT = {"escape": "Esc", "delete": "Del", "insert": "Ins", "pageup": "PgUp", "pagedown": "PgDn"}
_KEYS = {**_ARROWS, **_SHORT, "slash": "/", "space": "Space"}


def shown_key(key: str) -> str:
    """A key as it is written on a keyboard: ``ctrl+s`` → ``Ctrl+S``, ``question_mark`` → ``?``."""
    *held, last = key.split("+")
    if len(last) == 1:
        last = last.upper() if held else last
    else:
        sign = _KEYS.get(last) or key_to_character(last) or ""
        last = sign if sign and sign.isprintable() else last.capitalize()
    return "+".join([*(part.capitalize() for part in held), last])


def shown_keys(keys: str) -> str:
    """Keys separated by commas as people read them."""
    return "  ".join(map(shown_key, keys.split(",")))


def bindings(place: str) -> list[BindingType]:
    """The keys of a place for the widget or screen that has the methods."""
    return [Binding(each.keys, each.name, each.title, show=False) for each in ACTIONS[place]]


def hints(place: str) -> list[Action]:
    """The actions shown while a place has the focus, the most used first."""
    places = ("line", "anywhere") if place == "line" else (place,)
    own = [each for where in places for each in ACTIONS[where] if each.hint is not None]
    return sorted(own, key=lambda action: action.hint or 0)


_SIGNS = "Signs: " + ", ".join(f"{state.sign} {state}" for state in reversed(State))
_GROUND = (
    "Every change is solved and judged at once; until then the figures of the line before are "
    "dimmed. A number without a unit takes the unit shown. With the mouse: press a cell to go "
    "there, press it again to edit."
)
_OF_TEXTUAL: dict[str, Iterable[BindingType]] = {
    "On every screen, with Ctrl+P and Ctrl+Q": Screen.BINDINGS,
    "While a value is typed": Input.BINDINGS,
    "While the text is typed, as well": TextArea.BINDINGS,
    "Pictures, verdict and whatever is longer than the screen": ScrollableContainer.BINDINGS,
}
"""Keys that CALM leaves to the widgets it is made of; their meanings come from them."""


def all_keys() -> RenderableType:
    """Every key, by where it works."""
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
