"""The report of a design check on paper: what an engineer signs."""

import re
from dataclasses import dataclass, replace
from functools import cache

import pypdfium2
import pytest

import calm
from calm.checks.assess import RULES
from calm.checks.finding import State, governing_of_each_rule
from calm.drawing.check_figures import DrawnCase, elevation
from calm.files.check_limits import Checks
from calm.files.definition import Model
from calm.report.blocks import Table
from calm.report.check_report import check_report, mooring_section, short_section, signed_mooring
from calm.report.check_tables import named
from calm.report.folder import printed
from calm.report.load_cases import load_cases
from calm.report.open_items import (
    groups_of,
    open_items,
    percent_text,
    plain,
    verdict_sentence,
)
from tests.judged import LINES, judged, judged_hostile, unaccepting

_DOCUMENT = """document:
  id: M-2026-17
  revision: B
  date: 2026-11-20
  author: A. Martin
  checked: B. Li
  institution: Institute of Examples
  history:
    - {revision: A, date: 2026-10-02, by: A. Martin, change: first issue}
    - {revision: B, date: 2026-11-20, by: A. Martin, change: wire 20 m longer}

"""


@dataclass
class Sheet:
    """A page: its text, that of letters of 8 pt and more, the sizes, and whether it is grey."""

    text: str
    large: str
    sizes: set[float]
    grey: bool


def sheets(content):
    found = []
    with pypdfium2.PdfDocument(content) as pdf:
        for page in pdf:
            text = page.get_textpage()
            places = range(text.count_chars())
            letters = [chr(pypdfium2.raw.FPDFText_GetUnicode(text.raw, at)) for at in places]
            sizes = [round(pypdfium2.raw.FPDFText_GetFontSize(text.raw, at), 1) for at in places]
            image = page.render(scale=0.7).to_pil().convert("RGB")
            red, green, blue = (band.tobytes() for band in image.split())
            found.append(Sheet(
                " ".join(text.get_text_range().split()),
                "".join(one for one, size in zip(letters, sizes, strict=True) if size >= 8.0),
                {size for one, size in zip(letters, sizes, strict=True) if one.strip()},
                red == green == blue,
            ))  # fmt: skip
    return found


@pytest.fixture(scope="module")
def assessments(tmp_path_factory):
    """Lines of `lines/` by name, each with a document."""
    folder = tmp_path_factory.mktemp("signed")

    @cache
    def of(name):
        path = folder / f"{name}.yaml"
        text = (LINES / f"{name}.yaml").read_text(encoding="utf-8")
        path.write_text(text.replace("\nenvironment:", f"\n{_DOCUMENT}environment:", 1), "utf-8")
        return judged(path)

    return of


@pytest.fixture(scope="module")
def paper(assessments):
    """The pages of a line on a paper."""

    @cache
    def of(name, size="a4"):
        report = check_report([mooring_section(assessments(name), None, size)])
        return sheets(printed(report, size))

    return of


MOST_PAGES = {"upward-adcp-300m": 6, "deep-current-meters": 8, "taut-nylon-surface": 7}
THREE = [*MOST_PAGES]


@pytest.mark.parametrize("size", ["a4", "letter"])
@pytest.mark.parametrize("name", THREE)
def test_there_are_few_pages(paper, name, size):
    assert len(paper(name, size)) <= MOST_PAGES[name]


@pytest.mark.parametrize("name", THREE)
def test_nothing_but_the_listing_is_smaller_than_8_points(paper, name):
    *pages, last = paper(name)
    assert min(size for page in pages for size in page.sizes) == 8.0
    assert {size for size in last.sizes if size < 8.0} <= {6.0}


def test_a_long_file_is_in_the_attachment_alone(paper):
    assert "lines, in the attachment" in paper("deep-current-meters")[-1].text
    assert "use: float-stablemoor-1000lb" in paper("upward-adcp-300m")[-1].text


def test_every_page_has_number_revision_page_and_verdict(paper):
    pages = paper("upward-adcp-300m")
    for number, page in enumerate(pages, 1):
        head = "M-2026-17 rev. B Slope ADCP at 300 m design check DRAFT, passes by acceptance"
        assert page.text.startswith(f"{head} 2026-11-20"), page.text[:100]
        assert f"page {number} of {len(pages)}" in page.text
        assert "Institute of Examples CALM" in page.text


def test_one_hash_stands_on_all_pages_and_whole_on_the_last(paper):
    pages = paper("upward-adcp-300m")
    (whole,) = set(re.findall(r"\b[0-9a-f]{64}\b", pages[-1].text))
    found = {one for page in pages for one in re.findall(r"\b[0-9a-f]{12,}\b", page.text)}
    assert found == {whole, whole[:12]}


def keys_of(model):
    """The names of a schema that are no words."""
    names = set()
    for name, field in model.model_fields.items():
        names.add(name)
        inner = field.annotation
        if isinstance(inner, type) and issubclass(inner, Model):
            names |= keys_of(inner)
    return {name for name in names if "_" in name}


@pytest.mark.parametrize("name", [*THREE, "receiver-line", "profiler-mooring"])
def test_prose_has_no_keys_and_no_statistics_of_the_solver(paper, name):
    text = "\n".join(page.large for page in paper(name))
    assert "`" not in text
    assert not re.search(r"\b(march|marches|segments?)\b|e-0", text)
    assert not [key for key in keys_of(Checks) | {"working_load", "depth_rating"} if key in text]
    assert not re.search(r"\b[a-z]+_[a-z]+\b", text)


@pytest.mark.parametrize("name", THREE)
def test_every_rule_has_a_row_on_the_page_of_the_checks(assessments, name):
    section = mooring_section(assessments(name))
    tables = [block for part in section.parts for block in part.blocks if isinstance(block, Table)]
    (checks,) = [table for table in tables if table.title == "Checks in full"]
    rules = {one.rule for one in assessments(name).every_finding()}
    assert {row[1].text for row in checks.rows} == {RULES[one].title for one in rules}
    shown = [(row[1].text, row[0].state, row[5].text) for row in checks.rows]
    assert len(set(shown)) == len(shown) < 2 * len(rules)


@pytest.mark.parametrize("name", [*THREE, "receiver-line"])
def test_every_use_beyond_100_percent_stands_on_page_one(paper, assessments, name):
    found = governing_of_each_rule(assessments(name).every_finding())
    over = [one for one in found if (one.utilisation or 0.0) > 1.0]
    assert over
    for one in over:
        assert f"{RULES[one.rule].title} {percent_text(one.utilisation)}" in paper(name)[0].text


@pytest.mark.parametrize("name", THREE)
def test_colour_carries_no_meaning(paper, name):
    assert all(page.grey for page in paper(name))


def test_page_one_holds_what_is_signed(paper):
    first = paper("upward-adcp-300m")[0].text
    for words in (
        "Document M-2026-17", "Rev. B", "52° 18.000′ N, 014° 54.000′ W", "1800 m", "sub-surface",
        "Passes by acceptance: No check fails", "Load cases", "1s Default environment, strumming",
        "to scale, 1 :", "Open items", "Replace this example before signing", "Governing checks",
        "Drawn: A. Martin", "Checked: B. Li", "Approved", "waves, snap loads, fatigue",
        "wire 20 m longer (A. Martin)", "first issue (A. Martin)",
    ):  # fmt: skip
        assert words in first, words
    assert first.index("wire 20 m longer") < first.index("first issue")


def test_a_report_is_a_draft_until_it_has_number_revision_and_date(assessments, paper):
    assessment = replace(assessments("upward-adcp-300m"), findings=())
    assert not assessment.draft

    def verdict(file):
        stand = assessment.in_environments[0]
        leg = calm.Design(file).legs[0]
        return signed_mooring(
            replace(assessment, in_environments=(replace(stand, leg=leg),))
        ).verdict

    file = assessment.file
    assert verdict(file) == "Passes with open items"
    for name in ("id", "revision", "date"):
        lacking = replace(file, document=file.document.model_copy(update={name: None}))
        assert verdict(lacking) == "DRAFT, passes with open items"
    assert verdict(replace(file, document=None)) == "DRAFT, passes with open items"


def test_the_file_is_attached(assessments):
    section = mooring_section(assessments("tidal-adcp"))
    with pypdfium2.PdfDocument(printed(check_report([section]))) as pdf:
        (attached,) = [pdf.get_attachment(at) for at in range(pdf.count_attachments())]
        text = (bytes(attached.get_data())).decode()
        assert attached.get_name() == "tidal-adcp.yaml"
        assert "M-2026-17" in text and "three wheels" in text


def test_items_are_causes_and_not_findings(tmp_path):
    assessment = judged(unaccepting("upward-adcp-300m.yaml", tmp_path))
    items = open_items(assessment)
    assert [item.number for item in items] == list(range(1, len(items) + 1))
    order = [State.FAIL, State.UNKNOWN, State.WARN, State.ACCEPTED, State.ESTIMATED]
    places = [order.index(item.state) for item in items if item.state in order]
    assert places == sorted(places)
    heads = [item.head for item in items]
    assert "Meter 500 m, meter 900 m, meter 1500 m: pass with an estimated value." in heads
    assert len(items) < len([one for one in assessment.every_finding()
                             if one.state is not State.PASS])  # fmt: skip


def test_the_sentence_names_what_is_beyond_its_limit_without_failing(assessments):
    said = verdict_sentence(assessments("upward-adcp-300m"))
    items = "one warning (fish bite), one accepted exception"
    assert said.startswith(f"No check fails. Open items: {items}")
    beyond = said.partition("Above 100\u00a0% without being a failure: ")[2]
    assert beyond.startswith("lower swivel, 126\u00a0% (strength during launch)")
    assert "fish bite" not in beyond  # a rule with two states


def test_keys_of_a_file_are_quoted_words_in_print_and_keys_on_a_terminal():
    text = "Load is 12.35 kN; set its `working_load`, -3 m at most."
    assert plain(text) == "Load is 12.35\u00a0kN; set its “working load”, −3\u00a0m at most."
    assert plain(text, keys=True) == (
        "Load is 12.35\u00a0kN; set its `working_load`, −3\u00a0m at most."
    )


def test_cases_have_codes_and_still_water_comes_last():
    cases = load_cases(judged(LINES / "tidal-adcp.yaml", "ebb", "neaps"))
    assert [one.code for one in cases if one.as_given] == ["1", "2", "3"]
    assert cases[-1].code == "0" and [one.code for one in cases].count("0") == 1
    assert cases[1].words.startswith("ebb, ")


def test_an_elevation_has_one_scale_for_both_axes():
    (case, *_) = load_cases(judged(LINES / "chain-and-rope-surface.yaml"))
    svg, scale = elevation("m", [DrawnCase("1", case.results)], [], (280.0, 300.0))
    (path,) = re.findall(r'<path d="(M[^"]+)"[^>]*stroke-width="1.2"', svg)
    points = [tuple(map(float, one.split())) for one in re.split("[ML]", path) if one.strip()]
    shape = case.results[0].shape
    (x0, y0), (x1, y1) = points[0], points[-1]
    reach = float(((shape.x[0] - shape.x[-1]) ** 2 + (shape.y[0] - shape.y[-1]) ** 2) ** 0.5)
    assert abs(x1 - x0) * scale == pytest.approx(reach, abs=0.2 * scale)
    assert (y1 - y0) * scale == pytest.approx(shape.depth[-1] - shape.depth[0], abs=0.2 * scale)


def test_a_string_of_instruments_keeps_to_its_page(tmp_path):
    path = tmp_path / "string.yaml"
    clamps = ", ".join(f"{{use: sbe37, at: {at} m, label: logger {at}}}" for at in range(2, 92, 2))
    path.write_text(
        "name: String\n"
        "environment: {depth: 300 m, current: {speed: 0.4 m/s, toward: 90 deg}}\n"
        "line:\n"
        "  - {use: sphere-steel-1250, label: a float whose name is long beyond all need}\n"
        f"  - {{use: wire-jacketed-8, length: 100 m, clamps: [{clamps}]}}\n"
        "  - {use: release-ar861}\n"
        "  - {use: anchor-wheels-4}\n",
        encoding="utf-8",
    )
    first, second, third, *_ = sheets(printed(check_report([mooring_section(judged(path))])))
    assert "Approved" in first.text and "Mooring drawing" in second.text
    assert "Mooring drawing, continued" in third.text and "logger 90" in third.text


def test_names_that_mean_harm_keep_page_one(tmp_path):
    first, *others = sheets(printed(check_report([mooring_section(judged_hostile(tmp_path))])))
    assert "Approved" in first.text
    assert "alert(1)" in first.text
    assert "`e` $f_g$ {{ h }} #i" in " ".join(page.text for page in others)


def test_many_moorings_have_a_matrix_and_a_page_each(assessments):
    names = ("tidal-adcp", "compact-adcp", "upward-adcp-300m")
    sections = [short_section(assessments(name)) for name in names]
    first, *pages = sheets(printed(check_report(sections)))
    assert first.text.startswith("Design check of 3 moorings in")
    assert len(pages) == 3
    for section, page in zip(sections, pages, strict=True):
        assert section.name in first.text
        assert page.text.startswith(f"M-2026-17 rev. B {section.name}")
        assert "Over 100 %" in page.text and "Approved" in page.text
    assert first.grey and all(page.grey for page in pages)


def test_a_cell_of_the_matrix_is_black_where_a_mooring_fails(assessments, tmp_path):
    failing = judged(unaccepting("tidal-adcp.yaml", tmp_path), "ebb")
    report = check_report([short_section(failing), short_section(assessments("compact-adcp"))])
    tables = [block for block in report.front[0].blocks if isinstance(block, Table)]
    (matrix,) = [table for table in tables if table.title == "Highest utilisation, %"]
    heads = [column.heading for column in matrix.columns]
    assert heads == ["Mooring", "Water\nm", "E1", "E2", "Launch"]
    first, second = matrix.rows
    assert first[2].tone == first[3].tone == "fail"
    assert int(first[2].text.lstrip(">")) > 100
    assert second[2].tone == "" and second[3].text == "–"
    (governs,) = [table for table in tables if table.title == "Governing checks"]
    assert governs.rows[0][2].text.startswith("E1: excursion")
    assert governs.rows[1][2].text == "none"


def test_labels_that_follow_are_named_as_a_run():
    assert named(["glass 1", "glass 3", "cable", "glass 2"]) == "glass 1 to 3, cable"
    assert named(["a 1", "a 3", "b", "c", "d 7", "d 8"]) == "a 1, a 3, b and 3 more"
    assert named(["300 m", "500 m"]) == "300 m, 500 m"
    assert named(["d 7", "d 8"]) == "d 7 and 8"


def test_a_line_without_equilibrium_is_one_cause(tmp_path):
    """What needs an equilibrium is not reported again by the rules on launch and ascent."""
    text = (LINES / "upward-adcp-300m.yaml").read_text(encoding="utf-8")
    path = tmp_path / "sinking.yaml"
    sinking = text.replace("label: ADCP float}", "label: ADCP float, buoyancy: 100 N}")
    path.write_text(sinking.replace("glass-cluster-4", "shackle-13"), encoding="utf-8")
    assessment = judged(path)
    caused = [one.rule for one in assessment.all_findings() if "quilibrium" in one.message]
    assert "equilibrium" in {one.rule for one in assessment.all_findings()}
    assert not {"launch-strength", "launch-speed", "recovery"} & {*caused}


def test_forces_of_any_size_share_an_item(assessments):
    """Findings that differ only in component and values are one cause, in N or in kN."""
    one = next(assessments("upward-adcp-300m").every_finding())
    weak = replace(one, rule="slack", message="Minimum tension is 932 N.", state=State.WARN)
    strong = replace(weak, message="Minimum tension is 1.70 kN.", value=1700.0)
    assert len(groups_of([weak, strong], {})) == 1
