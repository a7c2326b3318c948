"""Lists in CSV and workbooks: headings in two languages, both directions, what people write."""

import io
import os
import zipfile

import pytest

from calm.case import load
from calm.errors import InputError
from calm.exchange.importing import import_file
from calm.exchange.model import ImportOptions
from calm.exchange.table.cells import number
from calm.files import Catalogue
from calm.files.pieces import parts_of

SITE = """\
environment:
  depth: 200 m
  current: {columns: [depth m, u m/s, v m/s], rows: [[0, 0.4, 0], [200, 0.1, 0]]}
"""

ENGLISH = """\
Item,Length (m),Diameter (mm),Wet weight (kg),Cd,Qty
Ball 40 in,1.04,1016,-433,0.65,1
1/2 in shackle,0.05,25,0.3,1.3,2
8 mm wire,100,8,24,1.3,1
AR861 release,1.0,130,22,1.2,1
13 mm chain,5,46,16,1.3,1
Anchor,0.4,,900,,1
Total,107.6,,529.6,,
"""

FRENCH = """\
Désignation;Longueur (m);Diamètre (mm);Poids dans l'eau (kg);Poids dans l'air (kg);Cx;Nombre
Ancre;0,4;;900;1030;;1
Chaîne de 13 mm;5;46;16;18;1,3;1
Largueur AR861;1,0;130;22;36;1,2;1
Câble de 8 mm;100;8;24;30;1,3;1
Manille 1/2";0,05;25;0,3;0,4;1,3;2
Bouée 40";1,04;1016;-433;150;0,65;1
TOTAL;107,6;;529,6;;;
"""


@pytest.fixture
def site(tmp_path):
    path = tmp_path / "site.yaml"
    path.write_text(SITE)
    return path


@pytest.fixture
def read(tmp_path, site):
    def read(text, name="list.csv", environment=site, bom=False, **options):
        path = tmp_path / name
        content = text if isinstance(text, bytes) else text.encode()
        path.write_bytes(b"\xfe\xff" + content if bom else content)
        return import_file(
            path, tmp_path / "m.yaml", environment=environment, options=ImportOptions(**options)
        )

    return read


def pieces(made, tmp_path):
    return load(tmp_path / "m.yaml", text=made.text).file.pieces


def test_english_and_french_say_the_same(read, tmp_path):
    answers = []
    for text in (ENGLISH, FRENCH):
        made = read(text)
        mooring = load(tmp_path / "m.yaml", text=made.text)
        answers.append(mooring.solve().to_dict())
        wire = next(piece.component for piece in mooring.file.pieces if piece.length == 100.0)
        assert wire.weight == pytest.approx(24 * 9.80665 / 100)
        assert wire.diameter == pytest.approx(0.008)
        assert [piece.component.role for piece in mooring.file.pieces] == [
            "float", "connector", "connector", "line", "release", "line", "anchor",
        ]  # fmt: skip
        assert any("a sum" in each.what for each in made.dropped)
        assert "whole length" in made.guessed[0].what
    one, other = answers
    assert one["top"]["depth"] == pytest.approx(other["top"]["depth"], abs=1e-6)
    assert one["anchor"]["tension"] == pytest.approx(other["anchor"]["tension"], rel=1e-6)


def test_semicolons_tabs_and_an_old_encoding(read):
    tabs = ENGLISH.replace(",", "\t")
    assert "count: 2" in read(tabs).text
    assert "Bouée" in read(FRENCH.encode("cp1252")).text


def test_columns_may_be_named(read, tmp_path):
    text = ENGLISH.replace("Item", "A").replace("Wet weight (kg)", "W").replace("Length (m)", "L1")
    with pytest.raises(InputError, match="no headings that CALM knows"):
        read(text)
    made = read(text, columns={"name": "A", "weight": "W", "length": "L1"})
    assert len(pieces(made, tmp_path)) == 7
    with pytest.raises(InputError, match="no column is called `Zebra`"):
        read(ENGLISH, columns={"name": "Zebra"})
    with pytest.raises(InputError, match="did you mean `length`"):
        read(ENGLISH, columns={"lenght": "Length (m)"})


def test_weights_that_are_those_of_a_metre(read, tmp_path):
    """By the heading, or since they are the same at different lengths."""
    headed = ENGLISH.replace("Wet weight (kg)", "Wet weight (kg/m)").replace(
        "100,8,24", "100,8,0.24"
    )
    wire = pieces(read(headed), tmp_path)[3].component
    assert wire.weight == pytest.approx(0.24 * 9.80665)
    same = ENGLISH.replace("100,8,24", "60,8,0.24").replace(
        "AR861", "8 mm wire,40,8,0.24,1.3,1\nAR861"
    )
    lines = [piece.component for piece in pieces(read(same), tmp_path) if piece.length == 60.0]
    assert lines[0].weight == pytest.approx(0.24 * 9.80665)


def test_figures_of_a_metre_and_of_whole_pieces_in_two_columns(read, tmp_path):
    """Floats lift, so that a second column of weights taken for masses had a negative one."""
    made = read(
        "name,length m,diameter mm,mass kg/m,mass kg,weight kg/m,weight kg\n"
        "Float,1,1000,,200,,-300\nWire rope,500,8,0.2,100,0.15,75\nAnchor,0.5,,,800,,700\n"
    )
    buoy, wire, anchor = (piece.component for piece in pieces(made, tmp_path))
    assert (buoy.mass, buoy.net_buoyancy) == (200.0, pytest.approx(300 * 9.80665))
    assert (wire.mass, wire.weight) == (0.2, pytest.approx(0.15 * 9.80665))
    assert anchor.weight == pytest.approx(700 * 9.80665)


def test_names_without_a_heading_units_below_and_no_anchor(read, tmp_path):
    """As a list of an institute has it: a title, units in a row of their own, no anchor."""
    text = (
        "Site 3,July 2022\n160,m design depth\n\n,Weight,Wet Weight,Length\n,(kg),(kg),(m)\n\n"
        '4 balls,3.5,-83.3,1.5\n1/2" shackle,0.37,0.32,0.05\n1/4" Tenex,0.74,0.19,24\n'
        '1" chain,38.6,33.7,2\nestimated stretch,0.005\n'
    )
    made = read(text)
    told = [str(each) for each in made.guessed]
    assert "line.anchor: the list has no anchor; one is added" in told
    assert any("read from the name" in each for each in told)
    assert any("has no size" in each for each in told)
    assert any("without length and weight" in str(each) for each in made.dropped)
    tenex = pieces(made, tmp_path)[2].component
    assert tenex.diameter == pytest.approx(0.00635)
    assert load(tmp_path / "m.yaml", text=made.text).solve()


def test_weights_that_count_up_are_told(read, tmp_path):
    """As Grelet's library has them, by name of its columns: negative for what sinks."""
    text = (
        "Category,Name,Mass (kg, Wet),Length (m),Projected area (m²),Normal drag coeff,"
        "Tangential drag coeff,Breaking strength (kg)\n".replace("(kg, Wet)", "(kg Wet)")
        + "Floats,FSAB 1200,486,1.25,1.23,0.5,0.5,\n"
        "Terminals,Shackle 5/8,-0.635,0.05,0.001,1.3,0.1,18000\n"
        "Ropes,8 mm wire,-18,100,0.008,1.3,0.1,3000\n"
        "Releases,Release,-25,1.2,0.237,1.2,0.9,\n"
        "Terminals,Shackle 5/8,-0.635,0.05,0.001,1.3,0.1,18000\n"
    )
    text = text.replace("8 mm wire,-18,100,0.008", "8 mm wire,-18,100,0.8")
    made = read(text)
    assert any("read as buoyancy" in str(each) for each in made.guessed)
    assert any("Tangential drag coeff" in str(each) for each in made.dropped)
    ball, shackle, wire, *_ = (piece.component for piece in pieces(made, tmp_path))
    assert ball.buoyancy == pytest.approx(486 * 9.80665)
    assert (ball.drag_area, ball.cd) == (1.23, 0.5)
    assert shackle.breaking_load == pytest.approx(18000 * 9.80665)
    assert wire.weight == pytest.approx(0.18 * 9.80665)
    assert wire.cn == pytest.approx(1.3)  # 0.8 m² of 100 m are the 8 mm of its name


def test_widths_are_of_cylinders_and_diameters_of_spheres(read, tmp_path):
    """As the tables of Mooring Design & Dynamics have it, with a row of units in centimetres."""
    text = (
        ",Buoyancy,Weight,Length,Width of,Diameter of,Drag Coef,Material\n"
        ",(kg),(kg),(m),CYL(cm),SPH(cm),,\n"
        "SB30,166,10,0.87,0,75,0.65,1\nRCM11,-5,10,0.75,13,0,1.3,1\n"
        "3/8 Kevlar rope,-1,0,100,0.9,0,1.3,6\nTrain wheels anchor,-600,0,0.35,100,0,1.3,1\n"
    )
    ball, meter, rope, _ = (piece.component for piece in pieces(read(text), tmp_path))
    assert (ball.kind, ball.diameter, ball.length, ball.mass) == ("sphere", 0.75, 0.87, 10.0)
    assert (meter.kind, meter.diameter, meter.cn) == ("cylinder", 0.13, 1.3)
    assert rope.stiffness == pytest.approx(6.9e10 * 3.14159265 / 4 * 0.009**2)


def test_headings_of_the_r_package_are_known(read, tmp_path):
    text = (
        '"name","buoyancy","height","area","CD","code"\n"61in ORE",999,1.65,2.138,0.65,1\n'
        '"SBE-16",-10,0.45,0.036,1.3,1\n"1/2 wire rope",-50,100,1.3,1.3,1\n'
        '"anchor",-2000,0.3,1,1.3,1\n'
    )
    ball, meter, wire, _ = pieces(read(text), tmp_path)
    assert (ball.length, meter.component.drag_area, meter.component.cd) == (1.65, 0.036, 1.3)
    assert wire.length == 100.0
    assert wire.component.diameter == pytest.approx(0.0127)


def test_diameters_of_zero_are_none(read, tmp_path):
    """A line has that of its name, a rigid piece no drag; each is told."""
    made = read(ENGLISH.replace("100,8,24", "100,0,24").replace("1.0,130,22", "1.0,0,22"))
    told = {each.where: each.what for each in made.guessed}
    assert told["components.8-mm-wire.diameter"] == "read from the name of the piece"
    assert "the drag is 0" in told["components.ar861-release.drag_area"]
    assert pieces(made, tmp_path)[3].component.diameter == 0.008


def test_unicode_text_of_excel_is_read(read):
    assert "Bouée" in read(FRENCH.encode("utf-16")).text
    assert "count: 2" in read(ENGLISH.replace(",", "\t").encode("utf-16-be"), bom=True).text


def test_the_sign_between_cells_is_the_one_of_most_lines(read, tmp_path):
    text = ENGLISH.replace("8 mm wire", '"8 mm wire; galvanised; \t grey"')
    assert len(pieces(read(text), tmp_path)) == 7


LIBRARY = """\
type,name,buoyancy_kg,length_m,width_m,diameter_m,drag,material,comment
floats,41in ORE,433,1.04,0,1.04,0.65,1,
wires,3/8 wire rope,-0.33,1,0.009,0,1.3,1,
chains,1/2 Shackle,-0.3,0.05,0.025,0,1.3,1,
anchors,2 Railway Wheels,-700,0.35,1,0,1.3,1,
"""

NAMES_ALONE = "CHAT3\n41in ORE\n1/2 shackle\n1/2 Shackle\n2 railway wheels\n"


def test_a_list_of_names_takes_its_figures_from_a_library(read, tmp_path):
    library = tmp_path / "elements.csv"
    library.write_text(LIBRARY)
    made = read(NAMES_ALONE, elements=library)
    assert made.guessed == ()
    mooring = load(tmp_path / "m.yaml", text=made.text)
    ball, shackle, _, anchor = mooring.file.pieces
    assert mooring.file.name == "CHAT3"
    assert ball.component.buoyancy == pytest.approx(433 * 9.80665)
    assert (shackle.component.kind, shackle.component.diameter) == ("cylinder", 0.025)
    assert anchor.component.weight == pytest.approx(700 * 9.80665)


def test_a_list_takes_from_a_library_what_it_lacks(read, tmp_path):
    """Lengths stand in the list; figures of a line are those of a metre."""
    library = tmp_path / "elements.csv"
    library.write_text(LIBRARY)
    text = "name,length\n41in ORE,1.5\n3/8 wire rope,80\n1/2 shackle,\n2 railway wheels,\n"
    made = read(text, elements=library)
    ball, wire, shackle, _ = pieces(made, tmp_path)
    assert (ball.length, shackle.length, wire.length) == (1.5, 0.05, 80.0)
    assert wire.component.weight == pytest.approx(0.33 * 9.80665)
    assert wire.component.stiffness == pytest.approx(1.38e11 * 3.14159265 / 4 * 0.009**2)


def test_a_library_of_that_program_is_read(read, tmp_path):
    """Its rows are cut by bytes, as Octave counts an arrow for three."""
    rows = {
        "floats": "AF36↑ float      155.500  10.0 150.0   0.0  91.0 0.65 1",
        "wires": "3/8 Kevlar          -0.023   0.0 100.0   0.9   0.0 1.30 6",
        "anchors": "2 Railway Wheels  -700.000   0.0  35.0 100.0   0.0 1.30 1",
    }
    text = "# Created by Octave\n"
    for group, row in rows.items():
        text += f"# name: {group}\n# type: sq_string\n# elements: 1\n# length: 60\n{row}\n\n"
    text += "# name: format\n# type: matrix\n# rows: 2\n# columns: 2\n 1 16\n 18 25\n"
    library = tmp_path / "mdcodes.mat"
    library.write_text(text)
    made = read("name,length\nAF36↑ Float,\n3/8 kevlar,50\n2 railway wheels,\n", elements=library)
    ball, rope, _ = pieces(made, tmp_path)
    assert ball.component.diameter == 0.91
    assert rope.component.stiffness == pytest.approx(6.9e10 * 3.14159265 / 4 * 0.009**2)
    with pytest.raises(
        InputError, match="is an element library of Mooring Design & Dynamics, not a mooring"
    ):
        import_file(library, tmp_path / "m.yaml")


LIBRARY_REFUSED = {
    "names without a library": (
        NAMES_ALONE.replace("\n", ";\n"),
        False,
        "has names but no values",
    ),
    "a name it lacks": (NAMES_ALONE.replace("41in ORE", "42in ORE"), True, "has `41in ore`"),
    "a line without length": (NAMES_ALONE.replace("1/2 shackle", "3/8 wire rope"), True, "length"),
    "a library for a mooring": (LIBRARY, False, "is a library of elements, not a mooring"),
    "a library for another program": ("MATLAB 5.0 MAT-file", True, "--elements is only for lists"),
}


@pytest.mark.parametrize("case", LIBRARY_REFUSED)
def test_what_a_library_cannot_give_is_named(case, read, tmp_path):
    text, given, message = LIBRARY_REFUSED[case]
    library = tmp_path / "elements.csv"
    library.write_text(LIBRARY)
    with pytest.raises(InputError) as error:
        read(text, elements=library if given else None)
    assert message in str(error.value)


def test_a_workbook_may_bring_its_water(tmp_path):
    """As those of Mooring Design & Dynamics do: the elements, and a sheet of heights and speeds."""
    openpyxl = pytest.importorskip("openpyxl", reason="writes the workbook")
    book = openpyxl.Workbook()
    for row in (
        ("Element", "Buoyancy", "Length", "Width", "Diameter", "Flag", "Cd", "ME"),
        ("41in ORE", 433, 1.04, 0, 1.04, 0, 0.65, None),
        ("3/8 wire rope", -33, 100, 0.009, 0, 1, 1.3, 1.38e11),
        ("2 Railway Wheels anchor", -700, 0.35, 1, 0, 0, 1.3, None),
    ):
        book.active.append(row)
    water = book.create_sheet("water")
    for row in (("z", "U", "V", "W", "rho"), (150, 0.5, 0.1, 0, 1025), (0, 0, 0, 0, 1025)):
        water.append(row)
    book.save(tmp_path / "design.xlsx")
    made = import_file(tmp_path / "design.xlsx", tmp_path / "m.yaml")
    mooring = load(tmp_path / "m.yaml", text=made.text)
    assert mooring.file.environment.depth == 150.0
    assert mooring.solve().to_dict()["top"]["y"] > 0.0
    assert any("Flag, ME" in str(each) for each in made.dropped)


def test_clamps_by_a_column(read, tmp_path):
    text = ENGLISH.replace("Qty", "Clamped at (m)").replace(",1\n", ",\n").replace(",2\n", ",\n")
    text = text.replace("AR861", "Logger,0.3,40,0.5,1.2,25\nAR861")
    (clamp,) = pieces(read(text), tmp_path)[2].clamps
    assert (clamp.use, clamp.at) == ("logger", 25.0)


CELLS = {
    "12.5": 12.5, "12,5": 12.5, "-3": -3.0, "−3": -3.0, "1 250": 1250.0, "1,250.5": 1250.5,
    "1e3": 1000.0, ".5": 0.5, "'7": 7.0, "~30": 30.0, "≈ 4,2 kg": 4.2, "25 m": 25.0, "ca. 3": 3.0,
    "": None, "-": None, "n/a": None, "NaN": None, "see note": None,
}  # fmt: skip


@pytest.mark.parametrize("cell", CELLS)
def test_numbers_as_people_write_them(cell):
    assert number(cell)[0] == CELLS[cell]


def test_a_number_with_words_is_told(read):
    made = read(ENGLISH.replace(",22,1.2", ",22 kg,1.2"))
    assert any("`22 kg` read as 22" in each.what for each in made.guessed)


REFUSED = {
    "words for a number": (ENGLISH.replace(",22,1.2", ",heavy,1.2"), "`heavy` is not a number"),
    "a line without length": (ENGLISH.replace("8 mm wire,100", "8 mm wire,"), "the length of the"),
    "no weight": (ENGLISH.replace(",-433,", ",,"), "the buoyancy is missing"),
    "nothing floats": (
        "Item,Length,Wet weight (kg)\nbar,1,3\nrod,1,3\n", "neither end of the list is a float"
    ),
    "a tow": (
        "Item,kind,Length,Wet weight (kg)\nwire,cable,100,30\nfish,body,1,80\n",
        "a tow cannot be read",
    ),
    "one piece": ("Item,Length,Wet weight (kg)\nAnchor,1,300\n", "has 1 pieces"),
    "no table": ("a,b,c\nd,e,f\ng,h,i\n", "no headings"),
    "more than a line has": (ENGLISH.replace(",1.3,2", ",1.3,990" ).replace(
        "AR861", "8 mm wire,1,8,1,1.3,990\n8 mm wire,1,8,1,1.3,990\nAR861"
    ), "has more than 2000 pieces"),
    "a thousand thousands": (ENGLISH.replace(",1.3,2", ",1.3,1000000"), "the count is 1000000"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_missing_is_named(case, read):
    text, message = REFUSED[case]
    with pytest.raises(InputError) as error:
        read(text)
    assert message in str(error.value)


def test_an_environment_is_needed(read):
    with pytest.raises(InputError, match="has no environment"):
        read(ENGLISH, environment=None)


def test_a_workbook_is_read(read, tmp_path):
    openpyxl = pytest.importorskip("openpyxl", reason="writes the workbook")
    book = openpyxl.Workbook()
    for row in ENGLISH.splitlines():
        cells = [
            float(cell) if cell.replace(".", "").isdigit() else cell for cell in row.split(",")
        ]
        book.active.append(cells)
    content = io.BytesIO()
    book.save(content)
    assert len(pieces(read(content.getvalue(), "list.xlsx"), tmp_path)) == 7


def test_a_damaged_workbook_is_refused(read):
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        archive.writestr("nothing", "here")
    for damaged in (content.getvalue(), content.getvalue()[:30]):
        with pytest.raises(InputError, match="workbook"):
            read(damaged, "list.xlsx")


MOORDS = """\
type,name,serial,bottom_height,height,length,section,bool_line,buoyancy,width,diameter,drag,\
material,comment,top_height,bool_clampon,total_buoyancy,num_inline,id,height_along_inline,\
clamped_to_name,clamped_to_serial,bool_fit,inline_bottom,inline_top,passive_weight,passive_drag,\
mooring
anchors,3 Wheels,,0.0,,0.55,,False,-1350.0,1.0,0.0,1.3,1,,0.55,False,-1350.0,1,0,,,,,,,,,M1
wires,3/8 wire rope,,0.55,,50.0,A,True,-16.5,0.009,0.0,1.3,1,,50.55,False,-17,2,1,,,,,,,,,M1
miscs,Logger,2927,,20.0,0.31,A,False,-0.25,0.11,0.0,1.3,5,,,True,,2,4,19.45,3/8 wire rope,,True,\
0.55,50.55,False,False,M1
rigging,16mm BS,,50.55,,0.06,,False,-0.65,0.025,0.0,1.3,1,,50.61,False,-0.65,3,2,,,,,,,,,M1
floats,41in ORE,,50.61,,1.04,,False,433.0,0.0,1.04,0.65,1,,51.65,False,433.0,4,3,,,,,,,,,M1
"""


def test_a_design_of_moords(read, tmp_path):
    made = read(MOORDS)
    assert made.format == "moords"
    top, shackle, wire, anchor = pieces(made, tmp_path)
    assert top.component.cx == 0.65
    assert shackle.component.role == "connector"
    assert wire.component.weight == pytest.approx(0.33 * 9.80665)
    assert wire.component.stiffness == pytest.approx(1.38e11 * 3.14159265 / 4 * 0.009**2)
    assert wire.clamps[0].at == pytest.approx(50.0 - 19.45)
    assert anchor.component.weight == pytest.approx(1350 * 9.80665)
    answer = load(tmp_path / "m.yaml", text=made.text).solve().to_dict()
    assert answer["status"] == "converged"


def test_a_design_of_moords_with_a_bad_number(read):
    with pytest.raises(InputError, match="drag is `much`"):
        read(MOORDS.replace("1.04,0.65", "1.04,much"))


def with_cell(heading, cell, *, name="8 mm wire"):
    """A list with a cell in one column, whose heading is given."""
    return (
        f"Item;Length (m);Diameter (mm);{heading}\nBall;1.04;1016;-4330\n"
        f"{name};100.5;8;{cell}\nAR861 release;1.1;130;22\nAnchor;0.4;;9000\n"
    )


WEIGHTS = {
    ("Weight in water", "30"): 30 * 9.80665,  # no inches: `in` is a word
    ("Weight in water (kN)", "3"): 3000.0,
    ("Weight in water [daN]", "30"): 300.0,
    ("Weight in water, kgf", "30"): 30 * 9.80665,
    ("Weight (wet, lbs)", "30"): 30 * 0.45359237 * 9.80665,
    ("Wet weight", "0.3 kN"): 300.0,
    ("Wet weight (kp)", "300 N"): 300.0,
    ("Gewicht unter Wasser [kN]", "0,3"): None,
    ("Peso en agua (kN)", "0.3"): 300.0,
    ("Weight_in_water_N", "30"): 30.0,
    ("Weight in water (kg/100m)", "30"): 30 * 9.80665 * 1.005,
}


@pytest.mark.parametrize(("heading", "cell"), WEIGHTS)
def test_a_weight_has_the_unit_that_is_written(heading, cell, read, tmp_path):
    weight = WEIGHTS[heading, cell]
    if weight is None:
        with pytest.raises(InputError, match=r"has decimal points, `1.04`"):
            read(with_cell(heading, cell))
        return
    wire = pieces(read(with_cell(heading, cell)), tmp_path)[1]
    assert wire.component.weight * wire.length == pytest.approx(weight)


def test_the_weight_of_a_piece_is_that_of_the_whole_whatever_that_of_lines_is(read, tmp_path):
    made = read(with_cell("Weight in water (kg/100 m)", "30"))
    ball = pieces(made, tmp_path)[0].component
    assert ball.net_buoyancy == pytest.approx(4330 * 9.80665)
    assert "read as the value of the whole piece" in " ".join(map(str, made.guessed))


@pytest.mark.parametrize(
    ("signs", "turned"), [((-1, 1, 1, 1), True), ((1, -1, -1, 1), False), ((1, -1, 1, 1), False)]
)
def test_a_list_of_which_all_signs_are_turned(signs, turned, read, tmp_path):
    """What sinks by its name has all the buoyancy, what floats none; one wrong sign is no proof."""
    lifts = [sign * lift for sign, lift in zip(signs, (450, 60, 45, 1500), strict=True)]
    made = read(
        "Item;Length (m);Buoyancy (kg);OD (mm)\n"
        f"Float;1.2;{lifts[0]};1250\nWire;500;{lifts[1]};8\nAR861 release;1.1;{lifts[2]};150\n"
        f"Anchor;0.5;{lifts[3]};900\n"
    )
    ball = pieces(made, tmp_path)[0].component
    assert ball.net_buoyancy == pytest.approx(450 * 9.80665)
    assert ("read as weight" in " ".join(map(str, made.guessed))) == turned
    assert ball.diameter == 1.25


LENGTHS = {
    "8 mm": 0.008, "0.1 km": 100.0, "330 ft": 100.584, "330 Fuß": 100.584, "55 fathoms": 100.584,
    "3960 pouces": 100.584, "100 metros": 100.0,
}  # fmt: skip


@pytest.mark.parametrize("cell", LENGTHS)
def test_a_length_has_the_unit_that_stands_behind_it(cell, read, tmp_path):
    made = read(ENGLISH.replace("8 mm wire,100,", f"8 mm wire,{cell},"))
    assert pieces(made, tmp_path)[3].length == pytest.approx(LENGTHS[cell])
    assert any(f"`{cell}` read as {cell}" in each.what for each in made.guessed)


DOUBTFUL = "Item;Length (m);Wet weight (kg)\nBall;1;-433\nWire 8 mm;1.250;24\nAnchor;1;900\n"
UNITS_BELOW = (
    "Item,Length,Diameter,Wet weight\n,m,ell,kg\nBall,1,1,-433\nWire,9,1,2\nAnchor,1,,900\n"
)
NOT_UNDERSTOOD = {
    "a unit of a heading": (
        with_cell("Weight in water (slug)", "30"),
        "row 1, column 4, `Weight in water (slug)`: `slug` is not a unit of force that CALM knows",
    ),
    "one unit of a row": (
        UNITS_BELOW, "row 1, column 3, `Diameter (ell)`: `ell` is not a unit of length"
    ),
    "behind a number": (
        ENGLISH.replace(",22,1.2", ",22 Stein,1.2"),
        "row 5, AR861 release: Wet weight (kg): `22 Stein`: `Stein` is not a unit of force",
    ),
    "a ton": (with_cell("Weight in water (tons)", "0.3"), "it may mean 907, 1000 or 1016 kg"),
    "a length for a weight": (with_cell("Weight in water (mm)", "3"), "not a unit of force"),
    "two units": (ENGLISH.replace("Length (m)", "Length (m) (ft)"), "names two units"),
    "a diameter of 8 m": (ENGLISH.replace("(mm)", ""), "is 8 m; is its unit correct?"),
    "two decimal signs": (
        FRENCH.replace("0,05", "0.05"),
        "has decimal points, `0.05` (row 6), and decimal commas, `0,4` (row 2)",
    ),
    "thousands or decimals": (DOUBTFUL, "`1.250` (row 3) may be 1250 or 1.250; write one of these"),
    "ropes beside pieces": (
        ENGLISH.replace("Cd,", "Length of rope below (m),"), "each line needs its own row"
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", NOT_UNDERSTOOD)
def test_what_is_not_understood_is_refused_with_its_place(case, read):
    text, message = NOT_UNDERSTOOD[case]
    with pytest.raises(InputError) as error:
        read(text)
    assert message in str(error.value)


def test_one_decimal_sign_holds_for_the_file(read, tmp_path):
    german = FRENCH.replace("Câble de 8 mm;100;", "Câble de 8 mm;1.250;")
    made = read(german)
    assert pieces(made, tmp_path)[3].length == 1250.0
    assert any("commas are decimal signs, as in `0,4` (row 2)" in str(one) for one in made.guessed)
    english = ENGLISH.replace("8 mm wire,100,", '8 mm wire,"1,250",')
    made = read(english)
    assert pieces(made, tmp_path)[3].length == 1250.0
    assert any(
        "commas separate thousands, as in `1,250` (row 4)" in str(one) for one in made.guessed
    )


LANGUAGES = {
    "German": "Bezeichnung;Länge [m];Durchmesser [mm];Gewicht im Wasser [kg];cw;Anzahl",
    "French": "Désignation;Longueur (m);Diamètre (mm);Poids dans l'eau (kg);Traînée;Nombre",
    "Norwegian": "Komponent;Lengde (m);Diameter (mm);Vekt i vann (kg);cw;Antall",
    "Spanish": "Nombre;Longitud (m);Diámetro (mm);Peso en agua (kg);Arrastre;Cantidad",
}  # fmt: skip


@pytest.mark.parametrize("language", LANGUAGES)
def test_headings_of_five_languages(language, read, tmp_path):
    rows = ENGLISH.replace(",", ";").split("\n", 1)[1]
    made = read(LANGUAGES[language] + "\n" + rows)
    assert made.text.partition("\n")[2] == read(ENGLISH).text.partition("\n")[2]


def test_no_piece_is_lost_without_a_word(read, tmp_path):
    """A row without a name is told, marks of repetition repeat, and sums are no piece."""
    ball = "17 in glass,0.5,432,-25,0.5,1\n"
    rows = [ball, ball.replace("17 in glass", ""), ball.replace("17 in glass", "ditto")]
    rows += [ball.replace("17 in glass", "do."), ball.replace("17 in glass", "3x17 in glass")]
    text = ENGLISH.replace("AR861", "".join(rows) + "AR861").replace("Total,", "TOTALS,")
    made = read(text)
    labels = [piece.component.name for piece in pieces(made, tmp_path)]
    assert labels.count("17 in glass") == 3
    guessed, dropped = ([str(each) for each in side] for side in (made.guessed, made.dropped))
    assert any("row 6" in each and "values but no name" in each for each in dropped)
    assert any("`TOTALS`, a sum" in each for each in dropped)
    assert any("row 7: `ditto` read as `17 in glass`" in each for each in guessed)
    assert made.text.count("kind: cable") == read(ENGLISH).text.count("kind: cable")
    assert any("the name counts 3 pieces" in each for each in guessed)
    german = read(ENGLISH.replace("Total,", "Summe,"))
    assert len(pieces(german, tmp_path)) == len(labels) - 4


ROPES = (
    "Vectran", "Plasma 12", "Samson Quantum", "Colmega", "Seil", "Drahtseil", "Trosse", "Filin",
    "Aussière", "Cuerda", "Cabo", "Dyneema", "Twaron", "Technora", "3x19", "Hercules", "Nr. 7",
)  # fmt: skip


@pytest.mark.parametrize("name", ROPES)
def test_what_is_long_and_thin_is_a_rope_whatever_it_is_called(name, read, tmp_path):
    wire = pieces(read(with_cell("Weight in water (kg)", "30", name=name)), tmp_path)[1]
    assert (wire.component.kind, wire.length) == ("cable", 100.5)


def test_columns_of_numbers_name_nothing(read, tmp_path):
    """Neither serial numbers nor an `Item` that counts."""
    rows = [line.split(",", 1) for line in ENGLISH.splitlines()]
    for heading in ("Item", "Item no", "Serial", "Part number"):
        text = f"{heading},Description,{rows[0][1]}\n" + "".join(
            f"{place},{name},{rest}\n" for place, (name, rest) in enumerate(rows[1:], 1)
        )
        assert [piece.component.name for piece in pieces(read(text), tmp_path)][:2] == [
            "Ball 40 in", "1/2 in shackle",
        ]  # fmt: skip


SHORT = """\
Name,Qty,Length (m),Diameter (mm),Weight in water (kg)
Float,1,1,1000,-350
Wire rope,1,100,8,16
Glass ball,12,0.43,430,-25
Release,1,0.9,130,25
Anchor,1,0.8,900,900
"""


@pytest.mark.parametrize("upward", [False, True])
def test_lengths_that_are_counted_from_an_end_are_refused(upward, read):
    heading, *rows = SHORT.splitlines()
    for i, length in enumerate(("1", "101", "101", "102.4", "103.2")):  # of whole metres
        words = rows[i].split(",")
        rows[i] = ",".join([*words[:2], length, *words[3:]])
    rows = rows[::-1] if upward else rows
    with pytest.raises(InputError, match="distances from an end of the line"):
        read("\n".join([heading, *rows]))


def test_a_release_of_400_m_is_asked_for_its_unit(read):
    with pytest.raises(InputError, match="Release: is 900 m long; is its unit"):
        read(SHORT.replace("1,0.9,", "1,900,"))


def test_totals_are_divided_by_their_count(read, tmp_path):
    told = SHORT.replace("Weight in", "Total weight in").replace("-25", "-300")
    made = read(told)
    assert pieces(made, tmp_path) == pieces(read(SHORT), tmp_path)
    assert any("divided by the count, 12" in str(each) for each in made.guessed)


def test_a_weight_of_all_that_is_given_as_of_one_is_refused(read):
    with pytest.raises(
        InputError,
        match=r"Glass ball: each piece .*cannot lift 300 kg.*if the buoyancy is for all 12",
    ):
        read(SHORT.replace("-25", "-300"))


def test_a_float_that_lifts_more_than_it_displaces_is_reported(read):
    made = read(SHORT.replace("-350", "-900"))
    said = "displaces only 80"
    assert any(said in str(each) and "cannot lift 900 kg" in str(each) for each in made.guessed)


def test_a_count_times_a_length(read):
    with pytest.raises(InputError, match="`2 x 200 m` contains a count and a value"):
        read(SHORT.replace("1,100,8", "1,2 x 200 m,8"))
    made = read(SHORT.replace("Wire rope", "2 x 50 m wire rope"))
    assert any("the name counts 2 pieces" in str(each) for each in made.guessed)


def test_norwegian_tables_with_headings_and_parts(read, tmp_path):
    text = """\
Navn\tLengde [m]\tDiameter [mm]\tVekt i vann [kg]
Bøye\t1\t1000\t-350
Stålvaier\t100\t8\t16
Utløser\t0,9\t130\t25
Anker\t0,8\t900\t900
"""
    made = read(text.encode("cp1252"))
    assert len(pieces(made, tmp_path)) == 4
    assert "4 pieces, total length 102.7 m" in made.understood
    assert "length = `Lengde [m]`" in made.understood


def test_other_sheets_and_what_is_hidden_are_reported(read):
    openpyxl = pytest.importorskip("openpyxl", reason="writes the workbook")
    book = openpyxl.Workbook()
    old, new = book.active, book.create_sheet("rev C & D")
    for row in SHORT.splitlines():
        for sheet in (old, new):
            sheet.append([float(c) if c.strip("-").isdigit() else c for c in row.split(",")])
    old.append(["Shackle", 1, 0.1, 20, 0.3])
    old.title, old.sheet_state = "old", "hidden"
    new.row_dimensions[3].hidden = True
    content = io.BytesIO()
    book.save(content)
    made = read(content.getvalue(), "list.xlsx")
    said = [str(each) for each in made.guessed]
    assert "sheet `rev C & D`: used; hidden sheets were ignored: `old`" in said
    assert "sheet `rev C & D`: hidden but read: row 3" in said
    assert "16 pieces of sheet `rev C & D`" in made.understood


def test_one_of_several_sheets_must_be_named(read):
    openpyxl = pytest.importorskip("openpyxl", reason="writes the workbook")
    book = openpyxl.Workbook()
    first, second = book.active, book.create_sheet("option B")
    first.title = "option A"
    for sheet in (first, second):
        for row in SHORT.splitlines():
            sheet.append([float(c) if c.strip("-").isdigit() else c for c in row.split(",")])
    second.append(["Shackle", 1, 0.1, 20, 0.3])
    content = io.BytesIO()
    book.save(content)
    said = r"2 sheets with headings: `option A` \(\d+ rows\), `option B` \(.*; select one"
    with pytest.raises(InputError, match=said):
        read(content.getvalue(), "list.xlsx")
    for name in ("option A", "option B"):
        made = read(content.getvalue(), "list.xlsx", sheet=name)
        assert f"pieces of sheet `{name}`" in made.understood
    with pytest.raises(InputError, match="no sheet `option C`; did you mean `option"):
        read(content.getvalue(), "list.xlsx", sheet="option C")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_a_pipe_is_refused_at_once(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError, match="not a regular file"):
        import_file(tmp_path / "pipe", tmp_path / "m.yaml")


GRADED = """\
Name,Length (m),Diameter (mm),Weight in water (kg),Breaking load (kN)
Float,1,1000,-350,
13 mm {} chain,5,13,{},{}
Anchor,0.8,900,900,
"""


def test_a_chain_keeps_its_grade(tmp_path, site):
    """Chain of grades 30 and 80 is alike but for its strength: 80 and 206 kN at 13 mm."""

    def matched(*figures):
        path = tmp_path / "list.csv"
        path.write_text(GRADED.format(*figures))
        made = import_file(path, tmp_path / "m.yaml", environment=site, match_catalogue=True)
        return [each.entry for each in made.matched if "chain" in each.entry]

    entries = Catalogue.load().all()
    for grade, id in (("30", "chain-short-g30-13"), ("80", "chain-g80-13")):
        chain = entries[id]
        weight = -5 * chain.net_buoyancy / 9.80665
        load = chain.breaking_load / 1e3
        assert matched(f"grade {grade}", weight, load)[0] == id
        other = "80" if grade == "30" else "30"
        assert not any(f"g{grade}" in each for each in matched(f"G{other}", weight, ""))
        assert not any(f"g{other}" in each for each in matched("alloy", weight, load))


PLANNED = """\
Name,Depth (m),Length (m),Diameter (mm),Weight in water (kg),Clamped at (m),Qty
Float,50,1,1000,-350,,1
RCM,51,0.8,130,15,,1
Wire rope,52,100,8,16,,1
Logger,60,0.3,60,2,8,1
Glass ball,152,0.43,430,-25,,4
Release,155,0.9,130,25,,1
Anchor,156,0.8,900,900,,1
"""


@pytest.mark.parametrize("heading", ["Depth (m)", "Planned depth [m]", "Tiefe (m)", "Profondeur"])
def test_a_column_of_depths_gives_the_planned_depths(heading, read, tmp_path):
    found = parts_of(pieces(read(PLANNED.replace("Depth (m)", heading)), tmp_path))
    planned = {part.label: part.planned_depth for part in found}
    assert {name: depth for name, depth in planned.items() if depth is not None} == {
        "float": 50.0, "rcm": 51.0, "logger": 60.0,
    }  # fmt: skip


@pytest.mark.parametrize(
    ("old", "new"),
    [("Depth (m)", "Depth rating (m)"), (",51,", ",6000,"), ("Depth (m)", "Rated to")],
)
def test_depths_that_are_no_places_plan_nothing(old, new, read, tmp_path):
    made = read(PLANNED.replace(old, new))
    assert all(part.planned_depth is None for part in parts_of(pieces(made, tmp_path)))
    told = [str(each) for each in made.guessed]
    assert (new == ",6000,") == (
        "column Depth (m): does not increase down the line and was ignored" in told
    )


@pytest.mark.parametrize("heading", ["Länge kumuliert [m]", "Distance from anchor (m)"])
def test_lengths_from_an_end_are_refused_by_their_heading(heading, read):
    text = ENGLISH.replace("Length (m)", heading)
    with pytest.raises(InputError, match="has distances from an end of the line"):
        read(text)
