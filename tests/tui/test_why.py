"""From what was found to its row, and from a row to why."""

from calm.checks.finding import State
from calm.files import Place
from calm.tui.live import judge, judge_fully
from calm.tui.verdict_pane import VerdictPane
from calm.tui.verdict_text import verdict_lines, why
from tests.tui.conftest import MOORING

WEAK = MOORING.replace("breaking_load: 20 kN", "breaking_load: 4 kN")


def chosen_text(pane):
    """Text of the selected line of the verdict."""
    return pane._lines[pane._chosen].text


def test_a_row_has_all_that_was_found_of_it_the_gravest_first():
    view = judge_fully(judge(WEAK))
    told = why(view, Place(1))
    assert told[0].state is State.FAIL and told[0].heading.startswith("Strength")
    assert [each.state.severity for each in told] == sorted(
        (each.state.severity for each in told), reverse=True
    )
    assert not why(view, Place(40))


def test_the_next_finding_and_why(drive, folder):
    path = folder / "weak.yaml"
    path.write_text(WEAK, encoding="utf-8")

    async def story(driver):
        driver.app.judging.ask_fully()
        await driver.settle()
        await driver.press("f8")
        assert driver.table.row.state is State.FAIL
        first = driver.table.cursor
        assert "breaking load" in driver.screen.splitlines()[-1]
        await driver.press("y")
        assert "back to the row" in driver.screen and "Strength" in driver.screen
        await driver.press("b")
        assert driver.table.has_focus and driver.table.cursor == first
        fails = [n for n, row in enumerate(driver.table.rows) if row.state is State.FAIL]
        for _ in fails:
            await driver.press("g")
            assert driver.table.cursor in fails
        assert driver.table.cursor == first

    drive(story, path)


def test_a_line_of_the_verdict_leads_to_its_row_and_back(drive, folder):
    path = folder / "weak.yaml"
    path.write_text(WEAK, encoding="utf-8")

    async def story(driver):
        driver.app.judging.ask_fully()
        await driver.settle()
        await driver.press("f6")
        pane = driver.app.focused
        assert isinstance(pane, VerdictPane)
        while "breaking load" not in chosen_text(pane):
            await driver.press("down")
        told = chosen_text(pane)
        await driver.press("enter")
        assert driver.table.has_focus and driver.table.spot == Place(1)
        assert "breaking load" in driver.screen.splitlines()[-1]
        await driver.press("escape")
        assert driver.app.focused is pane and chosen_text(pane) == told
        await driver.press("escape")
        assert driver.table.has_focus

        await driver.press("home")
        row = next(
            n for n, line in enumerate(driver.screen.splitlines()) if "breaking load" in line
        )
        await driver.pilot.click(offset=(pane.region.x + 6, row))
        await driver.pilot.pause()
        assert driver.table.has_focus and driver.table.spot == Place(1)

    drive(story, path)


def test_unknown_figures_lead_to_one_row_after_the_other(drive, small):
    async def story(driver):
        driver.app.judging.ask_fully()  # else the launch is judged while the rows are walked
        await driver.settle()
        assert driver.view.complete
        places = [
            row.spot
            for row in driver.table.rows
            if State.UNKNOWN in (each.state for each in why(driver.view, row.spot))
        ]
        assert len(places) > 1
        await driver.press("f6")
        lines = len(list(verdict_lines(driver.view)))
        for _ in range(lines):  # the first such line is of one row alone
            if "depth_rating of logger, deep logger" in chosen_text(driver.app.focused):
                break
            await driver.press("down")
        seen = []
        for _ in places:
            await driver.press("enter")
            seen.append(driver.table.spot)
            await driver.press("escape")
        assert len(set(seen)) > 1 and set(seen) <= set(places)

    drive(story, small)
