"""The deck on pages: everything is there, large enough, and the same again."""

import csv
import io
import json
import math
import re
import shutil
from functools import partial

import openpyxl
import pypdfium2
import pypdfium2.raw as pdfium
import pytest

from calm.drop import drop_plan
from calm.drop.fall import Fineness
from calm.shipped import shipped_folder

COMPONENTS = """\
components:
  ball: {kind: sphere, role: float, diameter: 1 m, mass: 300 kg, buoyancy: 4000 N}
  pack: {kind: body, role: float, length: 0.5 m, mass: 20 kg, buoyancy: 250 N, drag_area: 0.15 m^2,
    cd: 0.6}
  joint: {kind: body, role: connector, length: 0.05 m, mass: 0.4 kg, buoyancy: -3 N,
    drag_area: 0.002 m^2, cd: 1, name: swivel of a long name}
  rope: {kind: cable, diameter: 8 mm, weight: 0.5 N/m, mass: 0.1 kg/m}
  logger: {kind: cylinder, diameter: 40 mm, length: 0.3 m, buoyancy: -5 N}
  release: {kind: body, role: release, length: 0.8 m, mass: 30 kg, buoyancy: -220 N,
    drag_area: 0.1 m^2, cd: 1}
  weight: {kind: anchor, weight: 40 kN}
"""
LABELS = (
    "a label that somebody made so long that it has to wrap over several lines of the sheet",
    "מצוף עליון",
    "عوامة",
    "Unbreakable" * 9,
    "plain",
)


def mooring(pieces, environments=0):
    """A line of some pieces, each kind of row in it."""
    lines = ["  - {use: ball, label: top float, serial: T-1}"]
    for n in range((pieces - 3) // 5):
        lines += [
            "  - {use: shackle-13}",
            f"  - {{use: joint, serial: J-{n}}}",
            "  - {use: shackle-16}",
            f"  - {{use: rope, length: 10 m, serial: R-{n}, clamps: [{{use: logger, at: 2 m, "
            f"serial: L-{n}, label: logger {n} {LABELS[n % 5]}}}]}}",
            f"  - {{use: pack, serial: P-{n}}}",
        ]
    lines += ["  - {use: release, serial: AR-77}"] if pieces > 2 else []
    text = "name: Wall\ndocument: {id: M-17, author: A. Nobody}\nenvironment:\n  depth: 900 m\n"
    text += "  current: {speed: 0.1 m/s, toward: 90 deg}\nline:\n" + "\n".join(lines)
    text += "\n  - {use: weight}\n"
    if environments:
        given = (
            f"e{n}: {{current: {{speed: {n / 200} m/s, toward: 0}}}}" for n in range(environments)
        )
        text += f"environments: {{{', '.join(given)}}}\n"
    return text + COMPONENTS


def pages_of(content):
    """The text of each page, the smallest text in it [pt], and its size."""
    document = pypdfium2.PdfDocument(content)
    pages, smallest, matrix = [], math.inf, pdfium.FS_MATRIX()
    for page in document:
        read = page.get_textpage()
        pages.append("".join(read.get_text_range().split()))
        for sign in range(read.count_chars()):
            if pdfium.FPDFText_IsGenerated(read, sign) == 1:
                continue
            if chr(pdfium.FPDFText_GetUnicode(read, sign)).isspace():
                continue
            pdfium.FPDFText_GetMatrix(read, sign, matrix)
            size = pdfium.FPDFText_GetFontSize(read, sign) * math.hypot(matrix.c, matrix.d)
            smallest = min(smallest, size)
    sizes = {tuple(map(round, page.get_size())) for page in document}
    document.close()
    return pages, smallest, sizes


def packed(text):
    return "".join(text.split())


@pytest.fixture(autouse=True)
def dropped_in_few_steps(monkeypatch):
    """The plan of the drop from a chain of few bars: its figures are judged elsewhere."""
    monkeypatch.setattr("calm.deck.drop_plan", partial(drop_plan, fineness=Fineness(20, 20)))


@pytest.fixture
def deck(calm, folder):
    def make(text, *words):
        (folder / "m.yaml").write_text(text, encoding="utf-8")
        done = calm("deck", "m.yaml", "-o", "out", *words)
        assert done.code == 0, done.err
        return folder / "out", done.err

    return make


@pytest.mark.parametrize(
    ("pieces", "paper", "size"),
    [(2, "letter", (612, 792)), (43, "a3", (1191, 842)), (203, "a4", (595, 842))],
)  # fmt: skip
@pytest.mark.thorough
def test_everything_is_on_the_pages(deck, pieces, paper, size):
    out, _ = deck(mooring(pieces), "--page", paper)
    blocks = max(pieces - 3, 0) // 5
    for name in ("diagram.pdf", "deck.pdf"):
        pages, smallest, sizes = pages_of((out / name).read_bytes())
        text = "".join(pages)
        assert smallest >= 7.995
        assert sizes == {size}
        for n in range(blocks):
            for serial in ("J", "R", "L", "P"):
                assert f"{serial}-{n}" in text
            if n % 5 in (1, 2):  # right to left: words of both ways come in another order
                assert packed(LABELS[n % 5]) in text
            else:
                assert packed(f"logger {n} {LABELS[n % 5]}") in text
        # on the diagram; in the package in the deployment log and the cutting list, too
        assert text.count(packed("at 2.00")) == blocks * (1 if name == "diagram.pdf" else 3)
        for words in ("T-1", "M-17", "A.Nobody", "Symbols", "seabed", "sheet"):
            assert words in text
        # two ends of one line carry the same mark
        goes_on = re.findall(r"continuesat([A-Z])", text)
        assert goes_on == re.findall(r"from([A-Z])(?=\d\dmmshackle|pack|rope|joint)", text)
        assert len(set(goes_on)) == len(goes_on) >= pieces // 40
    if blocks:
        assert packed("joint 1 swivel of a long name · no. J-0") in text


@pytest.mark.thorough
def test_the_same_input_gives_the_same_bytes(deck):
    text = mooring(13)
    first = {path.name: path.read_bytes() for path in deck(text)[0].iterdir()}
    again = {path.name: path.read_bytes() for path in deck(text)[0].iterdir()}
    assert first == again
    assert set(first) >= {
        "deck.pdf", "diagram.pdf", "diagram.svg", "deployment.csv", "recovery.csv", "cutting.csv",
        "hardware.csv", "shipping.csv", "lifts.csv", "instruments.csv", "plan.json", "parts.csv",
        "deck.xlsx",
    }  # fmt: skip


def test_every_sheet_is_in_the_deck(deck):
    pages, _, _ = pages_of((deck(mooring(13))[0] / "deck.pdf").read_bytes())
    text = "".join(pages)
    for words in (
        "Deployment log", "Order over the side", "Soundings", "Recovery log", "Order of surfacing",
        "Cutting and marking list", "Hardware bill", "Shipping list", "Lifts", "Instrument sheet",
        "Heaviest single lift", "a lower bound", "logger 0", "SHA-256",
    ):  # fmt: skip
        assert packed(words) in text, words


def test_the_anchor_drop_is_planned_for_the_ship(deck):
    text = mooring(8).replace("length: 10 m", "length: 60 m").replace("900 m", "100 m")
    text = text.replace("weight: 40 kN", "weight: 8 kN, kt: 300 N/(m/s)^2")
    plans = []
    text = text.replace("line:", "position: {latitude: 48 deg, longitude: -5 deg}\nline:", 1)
    given = ("--ship-speed", "1.5 m/s", "--streamed", "50 m", "--course", "90 deg")
    roles = ", ".join(f"{role}: 3 min" for role in ("float", "instrument", "release", "line"))
    timed = text.replace("author: A. Nobody", f"author: A. Nobody, deck_time: {{{roles}}}")
    for written, words in ((text, ()), (timed, given)):
        out, said = deck(written, *words)
        plans.append(json.loads((out / "plan.json").read_text()))
        sheets = "".join(pages_of((out / "deck.pdf").read_bytes())[0])
        assert packed("Anchor drop plan") in sheets
        # how to use the program is for the screen, not for the bridge
        assert "deck_time" not in sheets
        assert ("set `deck_time`" in said) == (written is text)
    assert [plan["ship_speed"] for plan in plans] == [1.0, 1.5]
    assert [plan["course"] for plan in plans] == [270.0, 90.0]
    # eastward from the west; degrees at 48° on WGS 84: 74 625 and 111 190 m
    start, let_go = (plans[1][f"{place}_position"] for place in ("start", "let_go"))
    assert start["longitude"] < -5.0 < let_go["longitude"]
    east, north = plans[1]["let_go"]
    assert let_go["longitude"] == pytest.approx(-5.0 + east / 74_625.0, abs=1e-6)
    assert let_go["latitude"] == pytest.approx(48.0 + north / 111_190.0, abs=1e-6)
    assert plans[1]["streamed"] == pytest.approx(50.0, abs=0.1) != plans[0]["streamed"]
    # float, rope, logger, pack and release take 3 min each; 60 m of rope go out as it steams
    assert plans[0]["start"] is plans[0]["deck_time"] is plans[0]["start_position"] is None
    assert plans[1]["deck_time"] == 180.0
    assert plans[1]["start"]["time"] == pytest.approx(5 * 180.0 + 60.0 / 1.5)
    assert plans[1]["start"]["distance"] == pytest.approx(
        1.5 * plans[1]["start"]["time"] - plans[1]["tow_past"]
    )
    assert plans[1]["verdict"]["state"] in ("unknown", "fail")
    assert {"verdict", "fails", "unknown", "warns", "accepted", "estimated"} <= set(
        plans[1]["verdict"]
    )
    assert {"fall_time", "fall_back", "fall_back_band", "tow_past", "run_in", "path"} <= set(
        plans[0]
    )
    out, _ = deck(text, "--order", "anchor-first")
    pages, _, _ = pages_of((out / "deck.pdf").read_bytes())
    assert packed("Anchor drop plan") not in "".join(pages)
    assert json.loads((out / "plan.json").read_text())["status"] == "anchor-first"


def test_signs_that_no_font_has_are_reported(deck):
    text = mooring(8).replace("A. Nobody", "海 Nobody")
    out, said = deck(text.replace("label: top float", "label: top 浮"))
    assert "lacks 海 (U+6D77), 浮 (U+6D6E); � is printed instead in author, `top 浮`" in said
    pages, _, _ = pages_of((out / "deck.pdf").read_bytes())
    assert "isprintedinstead" in "".join(pages)
    assert packed("top �") in pages[0]
    assert "top 浮" in (out / "diagram.svg").read_text(encoding="utf-8")


def test_the_files_for_spreadsheets(deck):
    out, _ = deck(mooring(8).replace("use: ball, label: top float", 'use: ball, label: "=1+1"'))
    rows = [*csv.DictReader(io.StringIO((out / "cutting.csv").read_text()))]
    assert [row["label"] for row in rows] == ["rope"]
    assert (float(rows[0]["cut_length[m]"]), float(rows[0]["at_load[N]"])) == (10.0, 0.0)
    label, _, at = rows[0]["marks[m]"].rpartition("@")
    assert (label, float(at)) == (f"logger 0 {LABELS[0]}", 2.0)
    over = [*csv.DictReader(io.StringIO((out / "deployment.csv").read_text()))]
    assert [row["label"] for row in over][:2] == ["'=1+1", "shackle-13"]
    assert [row["serial"] for row in over if row["use"] == "logger"] == ["L-0"]
    up = [*csv.DictReader(io.StringIO((out / "recovery.csv").read_text()))]
    assert "weight" not in {row["label"] for row in up}
    shipped = [*csv.DictReader(io.StringIO((out / "shipping.csv").read_text()))]
    assert {row["use"]: row["mass[kg]"] for row in shipped}["logger"] == ""


def test_like_pieces_that_follow_one_another_are_one_row(deck):
    top = "{use: ball, label: top float, serial: T-1}"
    text = mooring(8).replace(top, "{use: ball, label: float, count: 4}")
    out, _ = deck(text)
    pages, _, _ = pages_of((out / "deck.pdf").read_bytes())
    log = next(page for page in pages if "Orderovertheside" in page)
    assert packed("1–5 float 1 – float 4 4 × ball; with 13 mm shackle") in log
    assert packed("float 2") not in log
    over = [*csv.DictReader(io.StringIO((out / "deployment.csv").read_text()))]
    assert [row["label"] for row in over][:4] == ["float 1", "float 2", "float 3", "float 4"]


@pytest.mark.parametrize(
    ("line", "most"),
    [("s1000", 5), ("s-tether", 7), ("fit-top-depth", 7), ("deep-current-meters", 11)],
)
@pytest.mark.thorough
def test_a_package_is_no_thicker_than_this(calm, folder, line, most):
    assert calm("deck", str(shipped_folder("lines") / f"{line}.yaml"), "-o", "out").code == 0
    pages, _, _ = pages_of((folder / "out" / "deck.pdf").read_bytes())
    assert len(pages) <= most


def test_the_logs_have_room_for_what_is_written_on_deck(deck):
    text = mooring(8).replace("{id: M-17,", "{id: M-17, ship: RV Example, cruise: EX-142,")
    text += (
        "releases: [{serial: AR-77, codes: {arm: 1A2B, release: 3C4D}}]\n"
        "deployed: {date: 2027-03-02, depth: 905 m,"
        " position: {latitude: 48.3 deg, longitude: -5.2 deg}}\n"
    )
    out, _ = deck(text)
    pages, smallest, _ = pages_of((out / "deck.pdf").read_bytes())
    held = (
        "RV Example", "EX-142", "station", "date, UTC", "observer", "wind, sea, current, weather",
        "AR-77", "arm: 1A2B", "release: 3C4D",
    )  # fmt: skip
    for name in ("Deployment", "Recovery"):
        log = next(page for page in pages if f"{name}log" in page)
        for words in held:
            assert packed(words) in log, words
    whole = "".join(pages)
    for words in ("uncorrected", "48° 18.000′ N", "905.0 m", "2027-03-02", "command sent, UTC"):
        assert packed(words) in whole, words
    # the diagram has what is held, what holds, and the codes; the hash is at the foot of each page
    assert packed("arm: 1A2B · release: 3C4D") in pages[0]
    assert packed("anchor in air, in water") in pages[0]
    assert all("SHA-256" in page for page in pages if "seabed" not in page)
    assert smallest >= 7.995


def test_the_workbook_holds_what_the_files_hold(deck):
    out, _ = deck(mooring(8).replace("use: ball, label: top float", 'use: ball, label: "=1+1"'))
    book = openpyxl.load_workbook(out / "deck.xlsx")
    assert book.sheetnames == [
        "parts", "cutting", "instruments", "hardware", "shipping", "lifts", "deployment",
        "recovery",
    ]  # fmt: skip
    for sheet in book:
        heads, *rows = sheet.iter_rows(values_only=True)
        own = [*csv.DictReader(io.StringIO((out / f"{sheet.title}.csv").read_text()))]
        assert [head.replace(" [", "[").replace(" ", "_") for head in heads] == [*own[0]]
        assert len(rows) == len(own)
        for row, told in zip(rows, own, strict=True):
            for cell, text in zip(row, told.values(), strict=True):
                if isinstance(cell, int | float):
                    assert cell == pytest.approx(float(text), rel=1e-5, abs=1e-9)
                else:
                    assert (cell or "") == text.removeprefix("'")
    first = book["parts"]["C2"]
    assert (first.value, first.data_type) == ("=1+1", "s")


def test_many_environments_are_design_currents(deck):
    out, _ = deck(mooring(8, environments=60))
    rows = [*csv.DictReader(io.StringIO((out / "instruments.csv").read_text()))]
    assert {row["greatest_in"] for row in rows} == {"e59"}
    assert {row["least_in"] for row in rows} == {"e0"}
    _, smallest, _ = pages_of((out / "deck.pdf").read_bytes())
    assert smallest >= 7.995


@pytest.mark.thorough
def test_several_moorings_each_have_a_folder(calm, folder):
    for name in ("north", "south"):
        text = mooring(3).replace("name: Wall", f"name: Deep/{name}")
        (folder / f"{name}.yaml").write_text(text)
    assert calm("deck", "north.yaml", "south.yaml", "-o", "out").code == 0
    assert sorted(path.name for path in (folder / "out").iterdir()) == ["Deep-north", "Deep-south"]
    assert (folder / "out" / "Deep-north" / "deck.pdf").exists()


@pytest.mark.parametrize(
    ("change", "code", "complaint"),
    [
        (("4000 N", "4000 kg"), 2, "4000 kgf"),
        (("buoyancy: 4000 N", "buoyancy: 1 N"), 3, "m.yaml"),
    ],
)
def test_nothing_is_written_of_what_cannot_be(calm, folder, change, code, complaint):
    (folder / "m.yaml").write_text(mooring(3).replace(*change))
    done = calm("deck", "m.yaml", "-o", "out")
    assert done.code == code
    assert complaint in done.err
    assert not (folder / "out").exists()


def test_usage(calm, folder, write_mooring):
    write_mooring()
    (folder / "file").write_text("")
    (folder / "tow.yaml").write_text("tow: {speed: 2 m/s, toward: 0}\nline: [{use: shackle-13}]\n")
    for words, complaint in (
        (("m.yaml",), "needs -o path"),
        (("m.yaml", "-o", "out", "--page", "a5"), "a5"),
        (("m.yaml", "-o", "file"), "is a file"),
        (("tow.yaml", "-o", "out"), "calm deck is only for moorings; these are tows: tow.yaml"),
        (("m.yaml", "-o", "out", "--ship-speed", "2"), "--ship-speed: `2` needs a unit: `2 m/s`?"),
        (("m.yaml", "-o", "out", "--ship-speed", "0 m/s"), "too slow to stream the line"),
        (("m.yaml", "-o", "out", "--streamed", "2 km"), "must be shorter than the line"),
    ):
        done = calm("deck", *words)
        assert (done.code, done.out) == (2, "")
        assert complaint in done.err.lower()
        assert not (folder / "out").exists()


@pytest.mark.thorough
def test_a_line_that_still_water_leaves_slack_is_dropped_all_the_same(deck):
    text = (
        "name: Slack\nenvironment: {depth: 100 m}\n"
        "line: [{use: ball}, {use: rope, length: 110 m}, {use: weight, kt: 300 N/(m/s)^2}]\n"
    )
    out, said = deck(text + COMPONENTS)
    assert "slack in still water" in said
    plan = json.loads((out / "plan.json").read_text())
    assert plan["rest_difference"] is None
    assert 0.0 < plan["fall_back"] < plan["streamed"]


def test_the_verdict_is_that_of_calm_check(calm, folder):
    """On standard error, in `plan.json` and at the head of the sheets, with what is accepted."""
    shutil.copy(shipped_folder("lines") / "upward-adcp-300m.yaml", "m.yaml")
    checked = json.loads(calm("check", "m.yaml", "--json", "-").out)
    head = calm("check", "m.yaml").out.splitlines()[1]
    done = calm("deck", "m.yaml", "-o", "sheets")
    counts = head.split("DRAFT")[1].strip()
    told = f"passes by acceptance: {counts}"
    assert f"m.yaml: design check ~ {told}; see calm check m.yaml" in done.err
    verdict = json.loads((folder / "sheets" / "plan.json").read_text())["verdict"]
    assert verdict["verdict"] == checked["verdict"] == "passes-by-acceptance"
    assert (verdict["fails"], verdict["accepted"]) == (0, 1)
    pages, _, _ = pages_of((folder / "sheets" / "deck.pdf").read_bytes())
    assert packed(told) in "".join(pages)


def test_a_title_block_of_long_texts_leaves_room_for_the_line(calm, write_mooring, folder):
    """A name of 3000 letters once left none, and the columns of the diagram were never found."""
    path = folder / write_mooring()
    text = path.read_text()
    path.write_text("name: " + "n" * 3000 + text[text.index("\n") :])
    assert calm("deck", path.name, "-o", "sheets").code == 0
    assert (folder / "sheets" / "diagram.svg").exists()
