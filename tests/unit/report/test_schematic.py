"""The schematic as a picture: read back from its XML, its texts measured in a wide font."""

import json
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

import calm
from calm.drawing.schematic import schematic_sheets, schematic_svg
from tests.drawings import SVG, assert_none_overlap, texts_of

LINES = sorted((Path(__file__).resolve().parents[3] / "lines").glob("*.yaml"))
NASTY = "<script>alert('x')</script> & \"q\""
LONG = "Very long name of a component that nobody can read in one go, WWWWWWWW " * 3


@pytest.fixture
def load(tmp_path):
    """Reads a mooring of items given as YAML, 1000 m of water."""

    def load(*items, name="Test", environment="depth: 1000 m", tow=None):
        text = [f"name: {json.dumps(name)}", f"environment: {{{environment}}}"]
        text += [f"tow: {tow}"] if tow else []
        text += ["line:", *(f"  - {item}" for item in items)]
        path = tmp_path / "m.yaml"
        path.write_text("\n".join(text), encoding="utf-8")
        return calm.load(path)

    return load


def item(use, label=None, **others):
    fields = {"use": use} | ({} if label is None else {"label": label}) | others
    return json.dumps(fields)


ANCHOR = item("anchor-wheels-4")


@pytest.mark.parametrize("path", LINES, ids=lambda path: path.stem)
@pytest.mark.parametrize("solved", [False, True])
@pytest.mark.thorough
def test_every_piece_and_clamp_of_a_shipped_line_is_named(path, solved):
    line = calm.load(path)
    svg = schematic_svg(line.file, line.solve() if solved else None)
    page = ElementTree.fromstring(svg)
    titles = [title.text for title in page.iter(f"{SVG}title")]
    pieces = [label for title in titles for label in title.split(", ")]
    for piece in line.file.pieces:
        assert piece.label in pieces
        assert all(clamp.label in titles for clamp in piece.clamps)
    assert_none_overlap(svg)


def test_a_long_line_is_divided_into_legible_sheets_with_the_same_parts():
    """A4 has 267 mm; text of 8 pt printed at two thirds stays legible."""
    path = next(one for one in LINES if one.stem == "tall-array-mooring")
    line = calm.load(path)
    sheets = schematic_sheets(line.file)
    shown = [[text for text, _ in texts_of(sheet)] for sheet in sheets]
    pages = [ElementTree.fromstring(sheet) for sheet in sheets]
    parts = [title.text for page in pages for title in page.iter(f"{SVG}title")]
    whole = ElementTree.fromstring(schematic_svg(line.file)).iter(f"{SVG}title")
    assert [one for one in parts if one != line.file.name] == [one.text for one in whole][1:]
    assert len(sheets) == 3
    for page, sheet in zip(pages, sheets, strict=True):
        height = float(page.get("viewBox").split()[3])
        printed = float(page.get("height").removesuffix("mm"))
        assert printed <= 267.01 and printed / (height * 25.4 / 72) >= 0.67
        assert_none_overlap(sheet)
    assert ["sea surface" in texts for texts in shown] == [True, False, False]
    assert [texts.count("seabed") for texts in shown] == [1, 1, 2]  # 1: the heading


@pytest.mark.thorough
def test_none_of_eighty_long_names_overlap(load):
    items = [item("sphere-ore-61in", f"{LONG} 0")]
    for number in range(1, 16):
        clamps = [{"use": "sbe37", "at": f"{at} m", "label": f"{LONG} {number}.{at}"}
                  for at in range(3)]  # fmt: skip
        items.append(
            item("polyester-19", f"{LONG} {number}", length="30 m", name=LONG, clamps=clamps)
        )
        items.append(item("shackle-13", f"{LONG} shackle {number}", name=LONG))
    items += [item("release-ar861", f"{LONG} a"), item("release-ar861", f"{LONG} b")]
    items.append(item("rcm11", LONG))
    line = load(*items, ANCHOR, name=LONG)
    count = sum(1 + len(piece.clamps) for piece in line.file.pieces)
    assert count == 80
    svg = schematic_svg(line.file)
    assert_none_overlap(svg)
    # every label and name is there to its last letter, in as many lines as it takes
    said = "".join("".join(shown.split()) for shown, _ in texts_of(svg))
    assert said.count("".join(LONG.split())) >= count - 1 + 30  # the anchor has none


def test_names_are_text_whatever_they_hold(load):
    names = [NASTY, "مرساة عائمة", "海洋观测", "Ω ≈ ü", "]]>", "-->"]
    items = [item("sphere-ore-61in", names[0])]
    items += [item("rcm11", name) for name in names[1:]]
    svg = schematic_svg(load(*items, ANCHOR, name=NASTY).file)
    page = ElementTree.fromstring(svg)
    assert {element.tag.removeprefix(SVG) for element in page.iter()} <= {
        "svg", "title", "g", "rect", "line", "circle", "ellipse", "path", "text",
    }  # fmt: skip
    assert set(names) <= {shown for shown, _ in texts_of(svg)}
    assert page.find(f"{SVG}title").text == NASTY


def test_signs_that_xml_lacks_or_that_turn_others_around_are_marked(load):
    svg = schematic_svg(load(item("sphere-ore-61in", "a\x1bb\x00c\u202ed\ud800e\nf"), ANCHOR).file)
    svg.encode("utf-8")
    assert "a\ufffdb\ufffdc\ufffdd\ufffde f" in {shown for shown, _ in texts_of(svg)}


def test_it_stands_beside_others_in_a_page(load):
    svg = schematic_svg(load(item("sphere-ore-61in"), ANCHOR).file)
    assert svg.count("http") == 1  # the name of its language
    assert not re.search(r"\b(id|class|style|href|src|on\w+)=", svg)
    assert "<style" not in svg


def test_the_same_line_gives_the_same_bytes():
    path = LINES[0].with_name("fit-top-depth.yaml")
    first, second = (
        schematic_svg(line.file, line.solve()) for line in map(calm.load, [path, path])
    )
    assert first == second


TALL = {"deep-current-meters": 390.0, "profiler-mooring": 310.0, "tall-array-mooring": 480.0}
"""Lines of so many pieces that their drawing is higher than an A4 page [mm]."""


@pytest.mark.parametrize("path", LINES, ids=lambda path: path.stem)
def test_a_shipped_line_fits_a4(path):
    page = ElementTree.fromstring(schematic_svg(calm.load(path).file))
    width, height = (float(page.get(name).removesuffix("mm")) for name in ("width", "height"))
    assert width <= 180.0
    assert height <= TALL.get(path.stem, 267.01)
    shown = [float(number) for number in page.get("viewBox").split()[2:]]
    assert width / height == pytest.approx(shown[0] / shown[1], rel=1e-3)


def cells(svg, label):
    """The figures right of a label, in the same line."""
    texts = texts_of(svg)
    at = [box for shown, box in texts if shown == label][-1]  # the headings come first
    beside = sorted((box[0], shown) for shown, box in texts if abs(box[1] - at[1]) < 0.1)
    return [shown for _, shown in beside if re.fullmatch(r"-|-?[\d.]+|\d+ × [\d.]+", shown)]


def test_figures_are_those_of_the_result():
    line = calm.load(LINES[0].with_name("fit-top-depth.yaml"))
    result = line.solve()
    svg = schematic_svg(line.file, result)
    wire = next(row for row in result.components if row.label == "polyester")
    assert cells(svg, "polyester") == [
        f"{wire.cut_length:.2f}", f"{wire.depth_top:.1f}", f"{1100.0 - wire.depth_top:.1f}",
    ]  # fmt: skip
    ctd = next(clamp for clamp in result.clamps if clamp.label == "CTD 230 m")
    assert cells(svg, "CTD 230 m") == [f"{ctd.depth:.1f}", f"{1100.0 - ctd.depth:.1f}"]
    assert cells(svg, "back-up glass 1–10")[0] == "10 × 0.51"
    assert cells(svg, "seabed") == ["1100.0", "0.0"]


def test_without_a_result_the_line_stands_upright(load):
    clamps = [{"use": "sbe37", "at": "40 m"}]
    rope = item("polyester-19", "rope", length="fit", top_depth="100 m", clamps=clamps)
    svg = schematic_svg(load(item("sphere-steel-1250", "ball"), rope, ANCHOR).file)
    # 1000 m of water less 100 m, the sphere of 1.25 m and the anchor of 0.70 m
    assert cells(svg, "rope") == ["898.05", "101.2", "898.8"]
    assert cells(svg, "sbe37") == ["141.2", "858.8"]
    assert cells(svg, "ball") == ["1.25", "100.0", "900.0"]


def test_depths_that_nothing_tells_are_left_out(load):
    slack = [item("sphere-steel-1250", "ball"), item("nylon-18", "rope", length="1200 m"), ANCHOR]
    assert cells(schematic_svg(load(*slack).file), "rope") == ["1200.00", "-", "-"]
    tow = load(
        item("wire-jacketed-8", "wire", length="fit", body_depth="50 m"), item("rcm11", "body"),
        environment="", tow="{speed: 2 m/s, toward: 0 deg}",
    )  # fmt: skip
    svg = schematic_svg(tow.file)
    assert cells(svg, "wire") == ["-", "-"]
    shown = [shown for shown, _ in texts_of(svg)]
    assert "ship" in shown
    assert "seabed" not in shown


def test_a_surface_float_rides_at_the_surface():
    line = calm.load(LINES[0].with_name("taut-nylon-surface.yaml"))
    for result in (None, line.solve()):  # without a result its hull tells
        shown = [shown for shown, _ in texts_of(schematic_svg(line.file, result))]
        assert "buoy" in shown
        assert "sea surface" not in shown


def test_a_tow_in_air_hangs_from_a_helicopter():
    line = calm.load(LINES[0].with_name("helicopter-bird.yaml"))
    shown = [shown for shown, _ in texts_of(schematic_svg(line.file))]
    assert "helicopter" in shown
    assert not {"sea surface", "seabed"} & set(shown)
