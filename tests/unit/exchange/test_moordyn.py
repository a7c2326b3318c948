"""Lines of MoorDyn and MoorPy, in the dialects of versions 1 and 2, single and as nets."""

from math import pi

import pytest

from calm.case import load
from calm.errors import InputError
from calm.exchange.importing import import_file

V2 = """\
--------------------- MoorDyn Input File ------------------------------------
A rope under a float
---------------------- LINE TYPES -------------------------------------------
TypeName   Diam    Mass/m     EA         BA/-zeta    EI         Cd     Ca     CdAx    CaAx
(name)     (m)     (kg/m)     (N)        (N-s/-)     (N-m^2)    (-)    (-)    (-)     (-)
rope       0.02    0.6        2e6        -0.8        0          1.6    1.0    0.05    0.0
---------------------- POINTS -----------------------------------------------
ID    Attachment  X     Y     Z      Mass   Volume  CdA    Ca
(#)   (-)         (m)   (m)   (m)    (kg)   (m^3)   (m^2)  (-)
1     Fixed       0     0     -200   0      0       0      0
2     Free        0     0     -140   30     0.01    0.2    0
3     Free        0     0     -100   100    0.6     0.5    0
---------------------- LINES ------------------------------------------------
ID   LineType   AttachA  AttachB  UnstrLen  NumSegs  LineOutputs
(#)  (name)     (#)      (#)      (m)       (-)      (-)
1    rope       1        2        60        10       p
2    rope       2        3        40        10       p
---------------------- OPTIONS ----------------------------------------------
0       writeLog    Write a log file
1025.0  WtrDnsty    water density (kg/m^3)
9.81    g           gravity
200     WtrDpth     water depth (m)
1       Currents    steady, from a file
---------------------- OUTPUTS ----------------------------------------------
FairTen1
------------------------- need this line ------------------------------------
"""

V1 = """\
MoorDyn input file
the same rope under the same float
---------------------- LINE DICTIONARY --------------------------------------
LineType  Diam   MassDenInAir  EA     BA/-zeta  Can   Cat  Cdn   Cdt
(-)       (m)    (kg/m)        (N)    (Pa-s/-)  (-)   (-)  (-)   (-)
rope      0.02   0.6           2e6    -0.8      1.0   0.0  1.6   0.05
---------------------- NODE PROPERTIES --------------------------------------
Node  Type     X    Y    Z     M    V     FX  FY  FZ  CdA  CA
(-)   (-)     (m)  (m)  (m)   (kg) (m^3) (kN)(kN)(kN) (m^2) (-)
1     Fixed    0    0    -200  0    0     0   0   0   0    0
2     Connect  0    0    -140  30   0.01  0   0   0   0.2  0
3     Connect  0    0    -100  100  0.6   0   0   0   0.5  0
---------------------- LINE PROPERTIES --------------------------------------
Line  LineType  UnstrLen  NumSegs  NodeAnch  NodeFair  Flags/Outputs
(-)   (-)       (m)       (-)      (-)       (-)       (-)
1     rope      60        10       1         2         p
2     rope      40        10       3         2         p
---------------------- SOLVER OPTIONS ---------------------------------------
0.001   dtM         time step
200     WtrDpth     water depth
1025    rhoW        density
9.81    g           gravity
1       Currents    steady
------------------------- need this line ------------------------------------
"""

CURRENT = """\
--------------------- MoorDyn steady currents File --------------------------
Tabulated file with the water currents components
z (m), ux (m/s), uy (m/s), uz (m/s)
-210 0.1 0 0
-200 0.1 0 0
0 0.5 0.1 0
5 0.5 0.1 0
"""


@pytest.fixture
def read(tmp_path):
    def read(text, current=CURRENT):
        if current is not None:
            (tmp_path / "current_profile.txt").write_text(current)
        path = tmp_path / "line.txt"
        path.write_text(text)
        return import_file(path, tmp_path / "m.yaml")

    return read


@pytest.mark.parametrize(
    ("kind", "current", "told"),
    [("3", CURRENT, None), ("2", CURRENT, "vary in time"), ("5", CURRENT, "vary in time"),
     ("1", None, "current_profile.txt is missing")],
)  # fmt: skip
def test_a_current_that_is_not_read_is_told(kind, current, told, read, tmp_path):
    """`Currents` as MoorDyn 2 numbers them: 1 and 3 are steady, the others have other files."""
    text = V2.replace("1       Currents", f"2  WaveKin\n{kind}  Currents")
    made = read(text, current)
    assert ("columns: [depth m, u m/s, v m/s]" in made.text) == (told is None)
    said = [str(each) for each in made.dropped]
    assert any("`WaveKin` 2" in each for each in said)
    assert [told in each for each in said if "Currents" in each] == [True] * bool(told)


@pytest.mark.parametrize("text", [V2, V1], ids=["version 2", "version 1"])
def test_both_dialects_say_the_same(text, read, tmp_path):
    made = read(text)
    assert made.format == "moordyn"
    mooring = load(tmp_path / "m.yaml", text=made.text)
    top, upper, weight, lower, anchor = mooring.file.pieces
    assert (upper.length, lower.length) == (40.0, 60.0)
    rope = lower.component
    assert (rope.diameter, rope.cn, rope.ct, rope.stiffness) == (0.02, 1.6, 0.05, 2e6)
    assert rope.weight == pytest.approx((0.6 - 1025 * pi / 4 * 0.02**2) * 9.81, rel=1e-6)
    assert (top.component.mass, top.component.volume) == (100.0, 0.6)
    assert weight.component.drag_area == 0.2
    assert anchor.component.kind == "anchor"
    answer = mooring.solve().to_dict()
    assert answer["status"] == "converged"
    lift = (1025 * 0.61 - 130) * 9.81 - 100 * rope.weight
    assert answer["anchor"]["vertical"] == pytest.approx(lift, rel=0.02)
    assert answer["top"]["y"] > 0.0


def test_a_held_upper_end_at_the_surface_is_the_float_of_its_point(read, tmp_path):
    text = V2.replace("3     Free        0     0     -100", "3     Vessel      0     0     -1  ")
    text = text.replace(
        "1    rope       1        2        60", "1    rope       1        2        180"
    )
    made = read(text)
    assert any("free to move" in str(each) for each in made.guessed)
    mooring = load(tmp_path / "m.yaml", text=made.text)
    top = mooring.file.pieces[0].component
    assert (top.kind, top.mass, top.volume) == ("body", 100.0, 0.6)  # those of its point
    assert mooring.solve().to_dict()["type"] == "surface"
    assert "held: {depth: 1 m" in read(text.replace("100    0.6", "0      0.0")).text
    assert "held: {depth: -3 m" in read(text.replace("     -1  ", "     3   ")).text


REFUSED = {
    "a sinking end": ("100    0.6", "1000   0.6", "not buoyant"),
    "a loose lower end": ("1     Fixed ", "1     Free  ", "both ends are free"),
    "a ring": (
        "1    rope       1        2 ", "1    rope       3        2 ", "a ring without a fixed point"
    ),
    "an unknown type": ("2    rope", "2    hemp", "`hemp` is not defined"),
    "an unknown point": ("2        3        40", "2        7        40", "line is not a point"),
    "no number": ("0.02    0.6", "wide    0.6", "`diameter` is `wide`"),
    "a body": (
        "---------------------- POINTS",
        "---------------------- BODIES ----\nID Attachment X0\n(#) (-) (m)\n1 coupled 0\n"
        "---------------------- POINTS",
        "does not support the bodies",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_read_is_refused(case, read):
    old, new, message = REFUSED[case]
    with pytest.raises(InputError, match=message):
        read(V2.replace(old, new, 1))


NETS = {
    "a platform": ("3     Free        0     0     -100", "3     Coupled     0     0     -30", 1),
    "a held joint": ("2     Free ", "2     Fixed", 2),
    "a bridle": (
        "2    rope       2        3        40        10       p\n",
        "2    rope       2        3        40        10       p\n"
        "3    rope       2        1        40        10       p\n",
        3,
    ),
}


@pytest.mark.parametrize("case", NETS)
def test_other_lines_are_nets(case, read, tmp_path):
    old, new, legs = NETS[case]
    net = load(tmp_path / "m.yaml", text=read(V2.replace(old, new, 1)).text)
    assert len(net.file.legs) == legs
    # the weight at the joint is on one leg alone
    assert [piece.use for piece in net.file.pieces].count("point-2") == (case != "a held joint")


def test_steady_forces_are_refused(read):
    with pytest.raises(InputError, match="is an external force"):
        read(V1.replace("30   0.01  0   0", "30   0.01  5   0"))


@pytest.mark.parametrize("share", [0.3, 0.5, 0.6])
def test_a_truncated_file_is_refused(share, read):
    with pytest.raises(InputError):
        read(V2[: int(share * len(V2))])
