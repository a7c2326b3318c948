"""Edits of a draft, each against the very text it has to give."""

import pytest

from calm.files.editing import Draft, EditError, clamps_of

TEXT = """\
name: Old   # of the line
environment:
  depth: 100 m

line:   # top to bottom
  # the float
  - {use: ball, label: 'top'}   # borrowed

  # the rope
  - use: rope
    length: 80 m   # cut
    clamps:
      - {use: meter, at: 5 m}   # upper
      - {use: meter, at: 9 m}

  - {use: dead}
# the end
solver: {drag: reynolds}
"""

NEW = {"use": "ring", "label": "a, b"}


def edited(before: str, after: str, text: str = TEXT) -> str:
    assert text.count(before) == 1
    return text.replace(before, after)


def test_items_are_as_written() -> None:
    ball, rope, dead = Draft(TEXT).items
    assert ball.values == {"use": "ball", "label": "top"}
    assert (ball.line, ball.column) == (7, 5)
    assert ball.text == "  # the float\n  - {use: ball, label: 'top'}   # borrowed\n"
    assert rope.values == {"use": "rope", "length": "80 m"}
    assert (rope.line, rope.column) == (10, 5)
    assert [clamp.values["at"] for clamp in rope.clamps] == ["5 m", "9 m"]
    assert rope.clamps[1].line == 14
    assert dead.text == "  - {use: dead}\n"


def test_a_text_with_mistakes_has_problems_and_no_items() -> None:
    for text in ("line: [\n", "", "- a\n", "a: &b c\n", "a: 1\na: 2\n", "a: !x b\n", "? [a]\n"):
        draft = Draft(text)
        assert draft.problems and not draft.items
        with pytest.raises(EditError, match="mistakes"):
            draft.put_at(("name",), "x")
    assert Draft("a: 1\na: 2\n").problems[0].line == 2


def test_insert() -> None:
    draft = Draft(TEXT)
    new = '  - {use: ring, label: "a, b"}\n'
    assert draft.insert(0, NEW).text == edited("  # the float\n", new + "  # the float\n")
    assert draft.insert(1, NEW).text == edited("# borrowed\n", "# borrowed\n" + new)
    assert draft.insert(3, NEW).text == edited("{use: dead}\n", "{use: dead}\n" + new)


def test_insert_with_clamps_takes_a_line_a_key() -> None:
    clamps = [{"use": "meter", "at": "1 m"}]
    after = Draft(TEXT).insert(3, {"use": "rope", "length": "9 m", "clamps": clamps})
    assert after.text == edited(
        "{use: dead}\n",
        "{use: dead}\n  - use: rope\n    length: 9 m\n    clamps:\n      - {use: meter, at: 1 m}\n",
    )


def test_delete_takes_the_comment_above() -> None:
    draft = Draft(TEXT)
    gone = "  # the float\n  - {use: ball, label: 'top'}   # borrowed\n"
    assert draft.delete([0]).text == edited(gone, "")
    assert draft.delete([]).text == TEXT
    assert draft.delete([0, 2]).text == edited(gone, "").replace("  - {use: dead}\n", "")
    emptied = draft.delete(range(3))
    assert "line: []   # top to bottom\n" in emptied.text
    assert "# the end\nsolver" in emptied.text
    refilled = emptied.insert(0, {"use": "ball"})
    assert "line:   # top to bottom\n  - {use: ball}\n# the end\n" in refilled.text


def test_move() -> None:
    draft = Draft(TEXT)
    moved = draft.move(2, 0)
    assert moved.text == edited("  - {use: dead}\n", "").replace(
        "  # the float\n", "  - {use: dead}\n  # the float\n"
    )
    ball = "  # the float\n  - {use: ball, label: 'top'}   # borrowed\n"
    assert draft.move(0, 2).text == edited(ball, "").replace(
        "{use: dead}\n", "{use: dead}\n" + ball
    )
    assert draft.move(1, 1).text == TEXT


def test_copy_and_paste_into_another_manner() -> None:
    snippets = Draft(TEXT).copy([1, 0])
    assert snippets[0] == "# the float\n- {use: ball, label: 'top'}   # borrowed\n"
    assert snippets[1].startswith("# the rope\n- use: rope\n  length: 80 m   # cut\n")
    windows = Draft("line:\r\n- {use: dead}\r\n").paste(0, snippets)
    assert windows.text.startswith("line:\r\n# the float\r\n- {use: ball, label: 'top'}")
    assert windows.text.count("\n") == windows.text.count("\r\n")
    inline = Draft("line: [{use: dead}]\n").paste(1, snippets[1:])
    assert inline.text == (
        "line: [{use: dead}, {use: rope, length: 80 m, "
        "clamps: [{use: meter, at: 5 m}, {use: meter, at: 9 m}]}]\n"
    )
    into_nothing = Draft("name: x\n").paste(0, snippets[:1])
    assert into_nothing.text == "name: x\nline:\n  " + snippets[0].replace("\n-", "\n  -")
    with pytest.raises(EditError, match="not a list of items"):
        Draft(TEXT).paste(0, ["hello"])


def test_duplicate() -> None:
    assert Draft(TEXT).paste(3, Draft(TEXT).copy([2])).text == edited(
        "  - {use: dead}\n", "  - {use: dead}\n" * 2
    )


def test_put() -> None:
    draft = Draft(TEXT)
    assert draft.put(0, "label", "it's").text == edited("'top'", "'it''s'")
    assert draft.put(1, "length", "fit").text == edited("80 m", "fit")
    assert draft.put(0, "count", "2").text == edited("'top'}", "'top', count: 2}")
    assert draft.put(1, "label", "x: y").text == edited(
        "- use: rope\n", '- use: rope\n    label: "x: y"\n'
    )
    assert draft.put(0, "label", None).text == edited(", label: 'top'", "")
    assert draft.put(1, "use", None).text == edited("use: rope\n    length", "length")
    assert draft.put(2, "label", None).text == TEXT
    with pytest.raises(EditError, match="item 3 does not exist; the list has 3"):
        draft.put(3, "label", "x")


def test_clamps() -> None:
    draft = Draft(TEXT)
    clamp = {"use": "meter", "at": "7 m"}
    below = "# upper\n"
    assert draft.insert(1, clamp, clamps_of(1)).text == edited(
        below, below + "      - {use: meter, at: 7 m}\n"
    )
    assert draft.insert(0, clamp, clamps_of(2)).text == edited(
        "{use: dead}", "{use: dead, clamps: [{use: meter, at: 7 m}]}"
    )
    assert draft.put(0, "at", "6 m", clamps_of(1)).text == edited("at: 5 m", "at: 6 m")
    one = draft.delete([1], clamps_of(1))
    assert one.text == edited("      - {use: meter, at: 9 m}\n", "")
    none = one.delete([0], clamps_of(1))
    assert "clamps" not in none.text and "length: 80 m   # cut\n\n  - {use: dead}" in none.text
    with pytest.raises(EditError, match="clamp 2 does not exist; the list has 2"):
        draft.delete([2], clamps_of(1))


def test_put_at_makes_the_mappings_that_lead_there() -> None:
    draft = Draft(TEXT)
    assert draft.put_at(("environment", "depth"), "90 m").text == edited("100 m", "90 m")
    assert draft.put_at(("position", "latitude"), "48 deg").text == edited(
        "# of the line\n", "# of the line\nposition: {latitude: 48 deg}\n"
    )
    assert draft.put_at(("environments", "winter storm", "depth"), "90 m").text == edited(
        "# the end\n", "\nenvironments:\n  winter storm:\n    depth: 90 m\n# the end\n"
    )
    assert draft.put_at(("solver", "strumming", "factor"), "1.5").text == edited(
        "{drag: reynolds}", "{drag: reynolds, strumming: {factor: 1.5}}"
    )
    current = {"speed": "0.5 m/s", "toward": "90 deg"}
    assert draft.put_at(("environment", "current"), current).text == edited(
        "depth: 100 m\n", "depth: 100 m\n  current: {speed: 0.5 m/s, toward: 90 deg}\n"
    )
    assert draft.put_at(("solver", "drag"), None).text == edited(
        "# the end\nsolver: {drag: reynolds}\n", ""
    )
    assert draft.put_at(("wind", "speed"), None).text == TEXT


TABLE = """\
environment:
  depth: 100 m
  current:   # measured
    columns: [depth m, speed m/s, toward deg]
    rows:
      - [0, 0.50, 90]   # surface
      # mid-water
      - [50, 0.3, 90]
      - [100, 0.1, 90]
line: []
"""


def test_put_table_leaves_the_rows_that_stay() -> None:
    columns = ["depth m", "speed m/s", "toward deg"]
    location = ("environment", "current")
    rows = [["0", "0.50", "90"], ["20", "0.4", "90"], ["50", "0.3", "90"], ["90", "0.1", "90"]]
    after = Draft(TABLE).put_table(location, columns, rows)
    assert after.text == edited("# surface\n", "# surface\n      - [20, 0.4, 90]\n", TABLE).replace(
        "[100,", "[90,"
    )
    other = Draft(TABLE).put_table(location, ["depth m", "u m/s", "v m/s"], rows[:1])
    assert "columns: [depth m, u m/s, v m/s]\n" in other.text
    fresh = Draft(TEXT).put_table(location, columns, rows[:2])
    assert fresh.text == edited(
        "depth: 100 m\n",
        "depth: 100 m\n  current:\n    columns: [depth m, speed m/s, toward deg]\n    rows:\n"
        "      - [0, 0.50, 90]\n      - [20, 0.4, 90]\n",
    )


def test_put_table_leaves_the_values_that_stay() -> None:
    columns = ["depth m", "speed m/s", "toward deg"]
    rows = [["0", "0.6", "90"], ["50", "0.3", "90"], ["100", "0.1", "80"]]
    after = Draft(TABLE).put_table(("environment", "current"), columns, rows)
    assert after.text == TABLE.replace("0.50", "0.6").replace("[100, 0.1, 90", "[100, 0.1, 80")


def test_a_uniform_current_takes_the_place_of_a_table() -> None:
    current = {"speed": "1 knot", "toward": "90 deg"}
    after = Draft(TABLE).put_at(("environment", "current"), current)
    assert "  current: {speed: 1 knot, toward: 90 deg}   # measured\nline" in after.text


def test_put_component() -> None:
    ball = {"kind": "sphere", "diameter": "1 m", "elongation": [["0.1", "0.03"]]}
    after = Draft(TEXT).put_component("my-ball", ball)
    assert "components:\n  my-ball:\n    kind: sphere\n    diameter: 1 m\n" in after.text
    again = after.put_component("my-ball", {"kind": "sphere"})
    assert "components:\n  my-ball:\n    kind: sphere\n# the end\n" in again.text
    flow = Draft("line: []\ncomponents: {a: {kind: sphere}}\n").put_component("b", {"kind": "body"})
    assert flow.text == "line: []\ncomponents: {a: {kind: sphere}, b: {kind: body}}\n"
    empty = Draft("components: { }   # own\n").put_component("b", {"kind": "body"})
    assert empty.text == "components:   # own\n  b:\n    kind: body\n"


def test_what_cannot_be_taken_apart_is_refused_and_nothing_is_lost() -> None:
    draft = Draft("line:\n  use: ball\n")
    assert not draft.items and not draft.problems
    with pytest.raises(EditError, match="line 2 of the file: `line` is not a list"):
        draft.insert(0, {"use": "ball"})
    with pytest.raises(EditError):
        Draft(TEXT).put(0, "label", "\x07")


def test_a_line_from_nothing() -> None:
    draft = Draft.empty()
    assert not draft.problems and not draft.items
    draft = draft.put_at(("environment", "depth"), "300 m").insert(0, {"use": "ball"})
    assert draft.value(("environment", "depth")) == "300 m"
    assert draft.text.endswith(
        "line:                              # top to bottom\n  - {use: ball}\n"
    )


def test_a_comment_goes_where_its_key_goes() -> None:
    sea = "environment:\n  # sea water of March\n  density: 1027 kg/m^3\n"
    deep = Draft(sea + "line: []\n").put_at(("environment", "depth"), "90 m")
    assert deep.text == sea.replace("  #", "  depth: 90 m\n  #") + "line: []\n"
    text = (
        "# of the file\nname: x\n\n# the water\nenvironment:\n  depth: 90 m\n    # charted\n"
        "  # from the ADCP,\n  # in May\n  current: {speed: 1 m/s, toward: 0 deg}\n"
        "  # storms\n  wind: {speed: 9 m/s, toward: 0 deg}\n"
    )
    calm = Draft(text).put_at(("environment", "current"), None)
    assert calm.text == text[: text.index("  # from")] + text[text.index("  # storms") :]
    assert calm.put_at(("environment", "depth"), None).text == (
        "# of the file\nname: x\n\n# the water\nenvironment:\n"
        "  # storms\n  wind: {speed: 9 m/s, toward: 0 deg}\n"
    )


def test_a_comment_that_a_file_begins_with_is_about_the_file() -> None:
    text = "# of the file\nenvironment: {depth: 9 m}\nline: []\n"
    named = Draft(text).put_at(("name",), "x")
    assert named.text == text.replace("env", "name: x\nenv")
    assert named.put_at(("name",), None).text == text


NESTED = """\
line:
  - use: rope
    length: 80 m
    clamps:
      # borrowed
      - use: meter   # serial 1234
        at: '10 m'
        drag_measurements: [[0.1, 1.2]]
      - {use: meter, at: "9 m"}
  - {use: rope, length: 5 m}
"""


def test_a_copied_clamp_is_worded_as_the_one_it_was_copied_from() -> None:
    draft = Draft(NESTED)
    upper = NESTED[NESTED.index("      # b") : NESTED.index("      - {use: meter")]
    lower = '      - {use: meter, at: "9 m"}\n'
    copied = draft.copy([0, 1], clamps_of(0))
    twice = draft.paste(2, copied, clamps_of(0))
    assert twice.text == NESTED.replace(upper + lower, (upper + lower) * 2)
    one_line = draft.paste(0, copied[1:], clamps_of(1))
    assert one_line.text == NESTED.replace("5 m}", '5 m, clamps: [{use: meter, at: "9 m"}]}')
    with pytest.raises(EditError, match="clamp 0 does not exist; the list has 0"):
        draft.copy([0], clamps_of(1))


def test_a_copy_in_brackets_keeps_its_quotes_and_lines() -> None:
    text = "line: [\n  {use: 'a', label: \"b\"},\n  {use: c}   # the last\n]\n"
    item = "  {use: 'a', label: \"b\"},\n"
    assert Draft(text).paste(1, Draft(text).copy([0])).text == text.replace(item, item * 2)


def test_comments_between_items_in_brackets_are_not_lost() -> None:
    draft = Draft("line: [\n  {use: a},   # one\n  {use: c}\n]\n")
    for change in (lambda: draft.delete([1]), lambda: draft.insert(0, {"use": "x"})):
        with pytest.raises(
            EditError, match=r"line 1 of the file: .* items or comments; edit the list in the text"
        ):
            change()
    assert draft.put(0, "use", "b").text == draft.text.replace("use: a", "use: b")
    assert Draft("line:\n  - use: d\n").paste(1, draft.copy([0])).text.endswith("  - {use: a}\n")


def test_a_value_of_a_text_with_mistakes_is_none() -> None:
    assert Draft("line: [").value(("line",)) is None
    assert Draft("line: [").text_at(("name",)) == ""
    assert not Draft("tow: [").is_tow and Draft("tow:\n").is_tow and not Draft("").is_tow


def test_a_clamp_moves_with_what_is_said_of_it() -> None:
    upper = "      - {use: meter, at: 5 m}   # upper\n"
    lower = "      - {use: meter, at: 9 m}\n"
    assert Draft(TEXT).move(0, 1, clamps_of(1)).text == edited(upper + lower, lower + upper)


@pytest.mark.parametrize("label", ["a\x07b", "\x1b[31mred", "a\x85b", "\u202eb"])
def test_a_control_character_is_refused_as_what_it_is(label: str) -> None:
    with pytest.raises(EditError, match="a control character cannot be written"):
        Draft(TEXT).put(0, "label", label)
    assert Draft(TEXT).put(0, "label", "a\tb").items[0].values["label"] == "a\tb"


NET = """\
name: A net
legs:
  upper:   # hangs free
    line:
    - {use: ball}
    - use: rope   # long
      length: 10 m
    bottom: {join: A}
  stem:
    top: {join: A}
    line: [{use: wire, length: 5 m, clamps: [{use: log, at: 1 m}]}, {use: weight}]
"""


def test_the_items_of_a_net_count_through_its_legs():
    draft = Draft(NET)
    assert [item.values["use"] for item in draft.items] == ["ball", "rope", "wire", "weight"]
    assert draft.lists.legs == ["upper", "upper", "stem", "stem"]
    assert draft.put(2, "length", "6 m").text == NET.replace("5 m", "6 m")
    assert draft.value((*clamps_of(2), 0, "at")) == "1 m"
    assert draft.put_at((*clamps_of(2), 0, "at"), "2 m").text == NET.replace("at: 1 m", "at: 2 m")
    without = NET.replace("    - use: rope   # long\n      length: 10 m\n", "")
    assert draft.delete([1, 3]).text == without.replace(", {use: weight}", "")
    assert draft.move(2, 3).lists.legs == draft.lists.legs
    with pytest.raises(EditError, match="cannot be moved to another leg"):
        draft.move(1, 2)


@pytest.mark.parametrize(("above", "leg"), [(False, "upper"), (True, "stem")])
def test_between_two_legs_an_item_is_put_where_it_is_meant(above, leg):
    draft = Draft(NET).insert(2, {"use": "new"}, above=above)
    assert draft.items[2].values == {"use": "new"}
    assert draft.lists.legs[2] == leg
    assert draft.delete([2]).text == NET


def test_all_items_of_a_leg_can_be_taken_out_and_put_in_again():
    draft = Draft(NET)
    emptied = draft.delete([0, 1])
    assert emptied.lists.legs == ["stem", "stem"]
    assert "    line: []\n" in emptied.text
    back = emptied.paste(0, draft.copy([0, 1]))
    assert back.lists.legs == draft.lists.legs
