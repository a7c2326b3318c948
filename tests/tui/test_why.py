"""From what was found to its row, and from a row to why."""

from calm.checks.finding import State
from calm.files import Place
from calm.tui.live import judge, judge_fully
from calm.tui.verdict_text import why
from tests.tui.conftest import MOORING

WEAK = MOORING.replace("breaking_load: 20 kN", "breaking_load: 4 kN")


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
