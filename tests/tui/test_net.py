"""A net of legs in the builder: its lists in one table, its picture and verdict, its edits."""

from tests.tui.conftest import MOORING

_, COMPONENTS = MOORING.split("\ncomponents:\n")
NET = f"""\
# Two floats, and a pennant.
name: A small net
environment:
  depth: 100 m
  current: {{speed: 0.3 m/s, toward: 90 deg}}

legs:
  main:
    line:
      - {{use: ball, label: top float}}     # carries all
      - {{use: rope, length: 30 m}}
    bottom: {{join: A}}
  pennant:
    top: {{join: A}}
    line:
      - use: rope
        length: 8 m
        clamps: [{{use: logger, at: 2 m}}]
      - {{use: releaser, label: weight below}}
    bottom: free
  stem:
    line:
      - {{use: rope, length: 40 m}}
      - {{use: weight}}
    top: {{join: A}}

components:
{COMPONENTS}"""


def written(folder):
    path = folder / "net.yaml"
    path.write_text(NET, encoding="utf-8")
    return path


def test_a_net_opens_with_its_legs_figures_picture_and_verdict(drive, folder):
    async def story(driver):
        rows = driver.table.rows
        legs = [row.texts.get("leg", "") for row in rows]
        assert legs == ["main", "", "pennant", "", "", "stem", ""]
        result = driver.view.result
        depths = [row.texts.get("depth") for row in rows if not row.spot.is_clamp]
        assert depths == [f"{depth:.1f}" for depth in result.components.depth_top]
        assert rows[3].texts["depth"] == f"{result.clamps[0].depth:.1f}"
        driver.app.judging.ask_fully()
        await driver.settle()
        assert driver.view.complete
        assert any(each.rule == "backup" for each in driver.view.findings)
        assert "Anchor of stem" in driver.screen
        assert "net of 3 legs" in driver.screen  # its picture from the side
        for number, words in (("2", "net of 3 legs"), ("3", "2000 N"), ("4", "weight below")):
            await driver.press(number)
            assert words in driver.screen

    drive(story, written(folder), size=(140, 50))


def test_a_piece_of_a_leg_is_edited_and_the_rest_stays_as_it_is(drive, folder):
    path = written(folder)

    async def story(driver):
        await driver.press("down", "l")
        await driver.press(*["backspace"] * 6)
        await driver.type("32 m")
        await driver.press("enter")
        await driver.settle()
        assert driver.text == NET.replace("length: 30 m", "length: 32 m")
        assert driver.view.result.components[1].cut_length == 32.0
        await driver.press("x")  # the piece above the node of main
        await driver.settle()
        changed = NET.replace("      - {use: rope, length: 30 m}\n", "")
        assert driver.text == changed
        await driver.press("u", "u")
        await driver.settle()
        assert driver.text == NET

    drive(story, path)


def test_pieces_go_into_the_leg_that_the_cursor_is_in(drive, folder):
    async def story(driver):
        await driver.press("c", "down", "v")  # the float again, as the last of its leg
        assert driver.session.draft.lists.legs[:3] == ["main", "main", "main"]
        await driver.press("u", "down", "V")  # and above the first of the next one
        assert driver.session.draft.lists.legs[:4] == ["main", "main", "pennant", "pennant"]
        assert driver.uses[2] == "ball"

    drive(story, written(folder))
