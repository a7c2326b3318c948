"""Configurations of oceanarray: pieces and instruments by their heights above the bottom.

The line is that of the mooring dune2 of the University of Hamburg, July 2026, as planned; heights
and serial numbers from the recovery report in the Python package oceanarray 0.5.1 (MIT licence,
© 2025 Eleanor Frajka-Williams).
"""

import pytest

import calm
from calm.errors import InputError, UsageError
from calm.exchange.importing import import_file
from calm.exchange.model import ImportOptions

LINE = """\
inline:
- {label: Float + beacon, serial: R01-024, hab: 683}
- {label: 3 glass on chain, hab: 660}
- {label: 3 glass on chain, hab: 454}
- {label: 3 glass on chain, hab: 163}
- {label: 5 glass on chain, hab: 15}
- {label: 2 Releases, serial: '761, 521', hab: 7}
- {label: Anchor 955kg, hab: 0}
"""
CLAMPS = """\
clamp:
- {serial: 240250, label: soloT, instrument: rbrsolo, hab: 675}
- {serial: 400115*, label: Aquadopp, instrument: aquadopp, hab: 626}
- {serial: 25586, label: SM, instrument: microcat, hab: 625}
- {serial: 9920*, label: Aquadopp, instrument: aquadopp, hab: 226, skip: true}
- {serial: 240231, label: soloT, instrument: rbrsolo, hab: 8}
"""
HEAD = """\
name: dune2_1_2026
waterdepth: 745
cruise: OdB
ship: Odon de Buen
latitude: 65 43.913
longitude: -27 48.000
"""
STANDS_FOR = {
    "rope": "parafil-kevlar-8-5",
    "Float + beacon": "glass-17in",
    "3 glass on chain": "glass-17in-chain-3",
    "5 glass on chain": "glass-17in-chain-5",
    "2 Releases": "release-ar861-double",
    "soloT": "rbr-xl200",
}


def imported(folder, text, stands_for=STANDS_FOR, elements=None):
    path = folder / "dune2_1_2026.mooring.yaml"
    path.write_text(text, encoding="utf-8")
    options = ImportOptions(defines=stands_for, elements=elements)
    return import_file(path, folder / "dune2.yaml", options=options)


def solved(found, folder):
    return calm.load(folder / "dune2.yaml", text=found.text).solve()


def test_pieces_and_instruments_stand_at_their_heights(tmp_path):
    found = imported(tmp_path, HEAD + LINE + CLAMPS)
    mooring = calm.load(tmp_path / "dune2.yaml", text=found.text)
    assert mooring.file.position.latitude == pytest.approx(65 + 43.913 / 60, abs=1e-6)
    assert mooring.file.position.longitude == pytest.approx(-27.8)
    clamps = mooring.solve().clamps.to_dicts()
    height = {clamp["label"]: mooring.water.depth - clamp["depth"] for clamp in clamps}
    # heights are those of the slack line; the floats stretch this rope by 2.4e-3 of it at most
    for label, asked in (("Aquadopp 626", 626), ("SM 625", 625), ("Aquadopp 226", 226)):
        assert height[label] == pytest.approx(asked, rel=2.5e-3)
    assert "serial: 400115" in found.text
    assert 'serial: "761, 521"' in found.text
    guessed = [str(one) for one in found.guessed]
    assert sum("catalog list microcat" in one for one in guessed) == 1
    assert not any("moved" in one for one in guessed)


def test_the_same_from_the_anchor_up_and_by_lower_and_upper_ends(tmp_path):
    down = imported(tmp_path, HEAD + LINE + CLAMPS).text
    head, *items = LINE.strip().split("\n")
    assert imported(tmp_path, HEAD + "\n".join([head, *items[::-1], ""]) + CLAMPS).text == down
    ends = LINE.replace("chain, hab: 660", "chain, hab_bottom: 658.5")
    ends = ends.replace("chain, hab: 454", "chain, hab_top: 455.5")
    assert imported(tmp_path, HEAD + ends + CLAMPS).text == down


def test_lines_that_are_listed_take_the_place_of_room(tmp_path):
    line = LINE.replace(
        "- {label: 5 glass", "- {label: rope, length: 146 m}\n- {label: 5 glass"
    ).replace("- {label: 2 Rel", "- {label: rope, length: 2, repeat: 3}\n- {label: 2 Rel")
    found = imported(tmp_path, HEAD + line)
    assert "length: 146 m" in found.text
    assert "length: 2 m, count: 3" in found.text
    assert not [one for one in found.guessed if "lines below" in str(one)]
    line = line.replace("146 m", "180 m")
    assert [one for one in imported(tmp_path, HEAD + line).guessed if "180 m long" in str(one)]


def test_figures_of_an_institutes_table(tmp_path):
    table = tmp_path / "table.csv"
    table.write_text(
        "name,kind,length [m],diameter [mm],buoyancy [kgf]\n"
        "rope,cable,1,10,-0.02\nFloat + beacon,sphere,0.6,600,60\n3 glass on chain,body,3,430,75\n"
        "5 glass on chain,body,3,430,125\n2 Releases,cylinder,0.75,140,-60\n"
        "soloT,cylinder,0.2,25,-0.1\nAquadopp,cylinder,0.6,75,-1\nSM,cylinder,0.6,62,-2\n",
        encoding="utf-8",
    )
    found = imported(tmp_path, HEAD + LINE + CLAMPS, {}, table)
    result = solved(found, tmp_path)
    # floats less what sinks: 60 + 3*75 + 125 - 60 - 2*0.1 - 2*1 - 2 - 0.02 of each metre of rope
    rope = 683 - 0.3 - 3 * 3 - 3 - 0.75
    kilograms = 60 + 225 + 125 - 60 - 0.2 - 2 - 2 - 0.02 * rope
    assert result.anchor.vertical == pytest.approx(kilograms * 9.80665, rel=2e-3)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (HEAD + CLAMPS, "lists 5 instruments but no line"),
        (HEAD.replace("745", "deep") + LINE, "waterdepth: `deep` is not a number"),
        (HEAD.replace("waterdepth: 745", "waterdepth:") + LINE, "needs `waterdepth`"),
        (HEAD + LINE.replace("hab: 15", "hab: 15, repeat: 1e9"), "`repeat` must be from 1 to 2000"),
        (HEAD + LINE + "- 7\n", "a list item must have keys"),
        (HEAD + LINE + "- {hab: 3}\n", "needs a name"),
        (HEAD + LINE + "clamp:\n- {instrument: aquadopp}\n", "needs `hab`"),
        (HEAD.replace("43.913", "63.913") + LINE, "latitude: `65 63.913` has minutes or seconds"),
        (HEAD + LINE.replace("hab: 660", "hab: 66o"), "hab: `o` is not a unit of length"),
    ],
)
def test_what_is_wrong_is_said_with_its_place(tmp_path, text, said):
    with pytest.raises(InputError) as caught:
        imported(tmp_path, text)
    assert said in str(caught.value)
    assert "mooring.yaml" in str(caught.value)


def test_all_that_is_not_known_is_said_at_once(tmp_path):
    with pytest.raises(InputError) as caught:
        imported(tmp_path, HEAD + LINE + CLAMPS, {"rope": "parafil-kevlar-8-5"})
    lines = [problem.line for problem in caught.value.problems]
    assert lines == sorted(lines)
    assert len(lines) == 5  # each name once
    with pytest.raises(InputError, match=r"no line is listed in the gap of .* and `2 Releases`"):
        imported(tmp_path, HEAD + LINE, {**STANDS_FOR, "rope": ""})
    with pytest.raises(UsageError, match="glass-17inch"):
        imported(tmp_path, HEAD + LINE, {**STANDS_FOR, "Float + beacon": "glass-17inch"})
