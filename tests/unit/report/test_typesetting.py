"""The fonts of the package, and what typst makes of a template."""

import pytest
from fontTools.ttLib import TTFont

from calm.drawing.typesetting import FONTS, lacking, legible, signs, typeset


def test_the_signs_are_those_of_the_font():
    assert signs() == set(TTFont(FONTS / "DejaVuSans.ttf").getBestCmap())


@pytest.mark.parametrize("name", ["DejaVuSans.ttf", "DejaVuSans-Bold.ttf"])
def test_both_fonts_have_what_reports_write(name):
    held = TTFont(FONTS / name).getBestCmap()
    assert all(ord(sign) in held for sign in "✓◦≈?▲✗°×−–…→≤≥±²³φ′₀₁√\u2003\ufffd")


@pytest.mark.parametrize("name", ["Regular", "Semibold", "It"])
def test_source_sans_has_what_papers_write(name):
    held = TTFont(FONTS / f"SourceSans3-{name}.otf").getBestCmap()
    assert all(ord(sign) in held for sign in "✓≈?▲°×–−…→≤≥±²³′○“”’\u00a0")


def test_the_fonts_bring_their_licences():
    assert "Bitstream" in (FONTS / "LICENSE").read_text(encoding="utf-8")
    ofl = (FONTS / "SourceSans3-LICENSE.md").read_text(encoding="utf-8")
    assert "SIL OPEN FONT LICENSE Version 1.1" in ofl and "Adobe" in ofl


def test_a_sign_that_the_fonts_lack_is_marked():
    assert lacking(["a海b", "海🛟"]) == "海🛟"
    assert legible("a海b") == "a\ufffdb"
    assert legible("19 °C") == "19 °C"


def test_a_template_gets_texts_as_data():
    template = b"#set document(date: none)\n#sys.inputs.text"
    once, again = (typeset(template, {"text": "#panic() $x$"}, "pdf") for _ in range(2))
    assert once == again
    assert once.startswith(b"%PDF")
    assert typeset(template, {"text": "#panic()"}, "png").startswith(b"\x89PNG")
