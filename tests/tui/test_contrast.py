"""Every sign, word and line of the screens can be read, in every theme and in a few colours."""

import pytest
from rich.color import Color, ColorSystem, ColorType
from rich.color_triplet import ColorTriplet

from calm.files.editing import Draft
from calm.shipped import shipped_folder
from calm.tui import theme
from calm.tui.theme import contrast

LEAST = 4.5
"""Of text, by WCAG 2.2, success criterion 1.4.3."""
SCREENS = (
    [], ["2"], ["3"], ["4"], ["1", "f6"], ["escape", "l"], ["escape", "space", "down"], ["a"],
    ["escape", "w"], ["escape", "o"], ["escape", "t"], ["escape", "question_mark"],
    ["escape", "m"], ["escape", "p"], ["escape", "ctrl+p"],
)  # fmt: skip
XTERM = [(0, 0, 0), (205, 0, 0), (0, 205, 0), (205, 205, 0), (0, 0, 238), (205, 0, 205),
         (0, 205, 205), (229, 229, 229), (127, 127, 127), (255, 0, 0), (0, 255, 0), (255, 255, 0),
         (92, 92, 255), (255, 0, 255), (0, 255, 255), (255, 255, 255)]  # fmt: skip
CONSOLE = [(0, 0, 0), (170, 0, 0), (0, 170, 0), (170, 85, 0), (0, 0, 170), (170, 0, 170),
           (0, 170, 170), (170, 170, 170), (85, 85, 85), (255, 85, 85), (85, 255, 85),
           (255, 255, 85), (85, 85, 255), (255, 85, 255), (85, 255, 255),
           (255, 255, 255)]  # fmt: skip
"""The sixteen colours of xterm, and of the console of Linux and of PCs."""
WHITE, BLACK = (255, 255, 255), (0, 0, 0)
GROUNDS = {True: (BLACK, (229, 229, 229)), False: (WHITE, BLACK)}


def seen(colour, palette, own, colours):
    """What a terminal of 8, 16 or 256 colours, or of all, shows for one; `own` for its default."""
    if colour is None or colour.is_default:
        return ColorTriplet(*own)
    if colour.type is ColorType.STANDARD:
        is_known = colour.number < colours
        return ColorTriplet(*(palette[colour.number] if is_known else own))
    if colours == 256:
        colour = colour.downgrade(ColorSystem.EIGHT_BIT)
    return colour.get_truecolor()


def unreadable(driver, palette, dark, colours):
    """The texts of the screen whose contrast is too low, each with it."""
    ground, ink = GROUNDS[dark]
    found = set()
    for strip in driver.app.screen._compositor.render_strips(driver.app.size):
        for text, style, _ in strip:
            if not text.strip() or style is None:
                continue
            if style.dim and colours < 256:
                found.add(("dim", text))  # terminals do as they like
            front = seen(style.color, palette, ink, colours)
            back = seen(style.bgcolor, palette, ground, colours)
            apart = contrast(front, back)
            if apart < LEAST:
                found.add((round(apart, 2), text.strip()[:30], str(style)))
    return found


async def look_at_all(driver, *kinds):
    found = {}
    for keys in SCREENS:
        await driver.press(*keys)
        await driver.settle()
        for palette, dark, colours in kinds:
            if low := unreadable(driver, palette, dark, colours):
                found[(*keys, palette is XTERM, colours)] = low
    assert not found


def line():
    return shipped_folder("lines") / "s1000.yaml"


def doubtful(folder):
    """A line of failures, warnings and what is not known, all of it in the table."""
    path = folder / "doubtful.yaml"
    text = line().read_text(encoding="utf-8").replace("environment:", "environment:", 1)
    draft = Draft(text)
    own = {"kind": "sphere", "role": "instrument", "diameter": "0.3 m", "buoyancy": "-20 N"}
    draft = draft.put_component("new-thing", own).insert(2, {"use": "new-thing"})
    path.write_text(draft.text, encoding="utf-8")
    return path


DARK, LIGHT = theme.DARK.name, theme.LIGHT.name
OTHERS = (DARK, "dracula", "solarized-light")


@pytest.mark.parametrize("theme", [LIGHT, *OTHERS])
@pytest.mark.thorough
@pytest.mark.usefixtures("painted")
def test_every_word_is_legible_in_every_theme(drive, folder, theme):
    async def story(driver):
        driver.app.theme = theme
        driver.app.judging.ask_fully()
        await driver.settle()
        dark = driver.app.current_theme.dark
        await look_at_all(driver, (XTERM, dark, 1 << 24), (XTERM, dark, 256))

    drive(story, doubtful(folder))


@pytest.mark.parametrize("ground, dark", [("15;0", True), ("0;15", False)])
@pytest.mark.thorough
@pytest.mark.usefixtures("painted")
def test_every_word_is_legible_in_eight_and_sixteen_colours(drive, folder, ground, dark):
    async def story(driver):
        driver.app.judging.ask_fully()
        await driver.settle()
        kinds = [(palette, dark, count) for palette in (XTERM, CONSOLE) for count in (8, 16)]
        await look_at_all(driver, *kinds)

    drive(story, doubtful(folder), environ={"TERM": "xterm", "COLORFGBG": ground})


def test_contrast_is_that_of_the_standard():
    """21 of black and white; 4.54 of #767676, the lightest grey for text on white (WebAIM)."""
    assert contrast(ColorTriplet(*BLACK), ColorTriplet(*WHITE)) == pytest.approx(21.0)
    grey = Color.parse("#767676").get_truecolor()
    assert contrast(grey, ColorTriplet(*WHITE)) == pytest.approx(4.54, abs=0.005)
