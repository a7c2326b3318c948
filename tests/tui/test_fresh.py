"""Figures of another state of the line than the one that is edited are dimmed."""

import threading
from contextlib import contextmanager

import pytest

from calm.tui import live
from calm.tui.pictures import Picture, ProfilePicture
from calm.tui.screen import TitleBar
from calm.tui.verdict_pane import VerdictPane
from tests.tui.conftest import MOORING

STORM = "environments: {storm: {current: {speed: 2 m/s, toward: 0 deg}}}\n"


@contextmanager
def nothing_judged(monkeypatch):
    """What is judged meanwhile comes out only at the end."""
    let, judge = threading.Event(), live.judge

    def held(*arguments, **options):
        assert let.wait(30)
        return judge(*arguments, **options)

    with monkeypatch.context() as patch:
        patch.setattr(live, "judge", held)
        try:
            yield
        finally:
            let.set()


def strength(driver, widget):
    """How far the signs of a widget stand out from its ground, at most, 0 to 1."""
    rows = driver.app.screen._compositor.render_strips(driver.app.size)
    region = driver.app.screen.query_one(widget).region
    return max(
        abs(sign - ground) / 255
        for strip in rows[region.y : region.bottom]
        for segment in strip.crop(region.x, region.right)
        if segment.text.strip() and segment.style
        for sign, ground in zip(
            segment.style.color.triplet, segment.style.bgcolor.triplet, strict=True
        )
    )


def strengths(driver):
    return [strength(driver, widget) for widget in (Picture, VerdictPane)]


def much_less(now, before):
    return all(one < 0.8 * other for one, other in zip(now, before, strict=True))


def figure_is_dimmed(driver):
    """Whether the depth of the first row is."""
    start = next(each.start for each in driver.table.columns if each.name == "depth")
    line = driver.table.render_line(1)
    return bool(line.crop(start, start + 8)._segments[0].style.dim)


async def waited(driver):
    """As after the time that a solution takes as a rule."""
    driver.app.judging.dim()
    await driver.pilot.pause()


def title(driver):
    return driver.screen.splitlines()[0]


@pytest.mark.parametrize(
    "tab", ["1", *(pytest.param(tab, marks=pytest.mark.thorough) for tab in "234")]
)
def test_while_a_change_is_solved_all_figures_are_dimmed(drive, small, monkeypatch, tab):
    async def story(driver):
        await driver.press(tab)
        before = strengths(driver)
        assert not figure_is_dimmed(driver)
        with nothing_judged(monkeypatch):
            await driver.press("d")
            assert "…" in title(driver) and not figure_is_dimmed(driver)  # not for a moment
            await waited(driver)
            assert figure_is_dimmed(driver)
            assert much_less(strengths(driver), before)
            assert "…" in title(driver)
            assert "✓" not in title(driver) and "!" not in title(driver)
        await driver.settle()
        assert not figure_is_dimmed(driver)
        assert strengths(driver) == pytest.approx(before, abs=0.1)
        driver.app.judging.ask_fully()
        await driver.settle()
        assert "…" not in title(driver)

    drive(story, small)


def test_on_the_way_out_nothing_is_dimmed(drive, small, monkeypatch):
    async def story(driver):
        with nothing_judged(monkeypatch):
            await driver.press("d")
            await driver.app.builder.query_one(TitleBar).remove()
            monkeypatch.setattr(driver.app, "_running", False)  # as Textual shuts down
            driver.app.judging.dim()
            monkeypatch.undo()

    drive(story, small)


def test_the_figures_of_another_environment_are_dimmed(drive, small, monkeypatch):
    small.write_text(MOORING + STORM)

    async def story(driver):
        assert "default environment" in title(driver)
        before = strengths(driver)
        with nothing_judged(monkeypatch):
            await driver.press("e")
            assert "environment storm   …" in title(driver)
            await waited(driver)
            assert figure_is_dimmed(driver)
            assert much_less(strengths(driver), before)
        await driver.settle()
        assert "environment storm" in title(driver)
        assert not figure_is_dimmed(driver)

    drive(story, small)


def test_the_same_text_elsewhere_is_judged_there(tmp_path):
    view = live.judge(MOORING, tmp_path / "one.yaml", "storm")
    assert view.is_of(MOORING, tmp_path / "one.yaml", "storm")
    assert not view.is_of(MOORING, tmp_path / "two.yaml", "storm")
    assert not view.is_of(MOORING, tmp_path / "one.yaml", None)
    assert not view.is_of(MOORING + "#", tmp_path / "one.yaml", "storm")
    assert live.judge(MOORING).is_of(MOORING, None, None)


def test_the_water_is_dimmed_as_well(drive, small, monkeypatch):
    async def story(driver):
        await driver.press("w")
        await driver.settle()
        before = strength(driver, ProfilePicture)
        with nothing_judged(monkeypatch):
            await driver.press("ctrl+u")
            await driver.type("120")
            await driver.press("enter")
            await waited(driver)
            assert strength(driver, ProfilePicture) < 0.8 * before
            assert "…" in title(driver)
        await driver.settle()
        assert strength(driver, ProfilePicture) == pytest.approx(before, abs=0.1)

    drive(story, small)


def test_the_last_profile_stays_dimmed_where_the_water_cannot_be_read(drive, small):
    async def story(driver):
        await driver.press("w")
        await driver.settle()
        profile = driver.app.screen.query_one(ProfilePicture)
        before = strength(driver, ProfilePicture)
        profile.show(live.judge(MOORING.replace("100 m ", "100 kg ")))
        await driver.pilot.pause()
        assert 0.0 < strength(driver, ProfilePicture) < 0.8 * before

    drive(story, small)


def test_a_new_row_shows_no_figures_until_they_are_its_own(drive, small):
    async def story(driver):
        before = driver.table.rows[0].texts["depth"]
        driver.app.judging.ask = lambda: None  # nothing is judged any more
        await driver.press("c", "V")
        assert driver.uses[:2] == ["ball", "ball"]
        assert "depth" not in driver.table.rows[0].texts
        assert driver.table.rows[1].texts["depth"] == before

    drive(story, small)
