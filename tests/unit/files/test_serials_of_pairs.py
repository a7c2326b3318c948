"""Serial numbers of assemblies, and of components that are several items, such as a pair."""

import pytest

from calm.case.design import load
from calm.errors import InputError
from calm.files.pieces import parts_of

FILE = """
name: pair
environment: {{depth: 200 m}}
line:
  - {{use: ball}}
  - {{use: wire-jacketed-8, length: 20 m}}
  - {{{item}}}
  - {{use: anchor-wheels-3}}
components:
  ball: {{kind: sphere, role: float, diameter: 1 m, buoyancy: 4000 N}}
  pair: {{kind: body, role: release, items: 2, length: 1 m, drag_area: 0.2 m^2, cd: 1,
    buoyancy: -400 N}}
  links: {{kind: chain, diameter: 13 mm}}
  logger: {{kind: cylinder, diameter: 50 mm, length: 0.3 m, buoyancy: -5 N}}
  set: {{kind: assembly, parts: [{{use: shackle-13}}, {{use: pair}},
    {{use: links, length: 1 m, clamps: [{{use: logger, at: 0.5 m}}]}}]}}
  floats: {{kind: assembly, parts: [{{use: shackle-13}}, {{use: ball}}, {{use: ball}}]}}
"""


def serials(folder, item):
    path = folder / "m.yaml"
    path.write_text(FILE.format(item=item), encoding="utf-8")
    parts = parts_of(load(path).file.pieces)
    return [(part.use, part.serials, part.serial) for part in parts if part.serials]


@pytest.mark.parametrize(
    ("item", "expected"),
    [
        ("use: pair, serial: [1, 2]", [("pair", ("1", "2"))]),
        ("use: pair, serial: lot 7", [("pair", ("lot 7",))]),
        ("use: pair, count: 2, serial: [1, 2, 3, 4]", [("pair", ("1", "2")), ("pair", ("3", "4"))]),
        ("use: set, serial: [1, 2, L]", [("pair", ("1", "2")), ("logger", ("L",))]),
        ("use: set, count: 2, serial: [1, 2, L, 3, 4, M]",
         [("pair", ("1", "2")), ("logger", ("L",)), ("pair", ("3", "4")), ("logger", ("M",))]),
        ("use: floats, serial: [F1, F2]", [("ball", ("F1",)), ("ball", ("F2",))]),
    ],
)  # fmt: skip
def test_each_item_gets_its_number(tmp_path, item, expected):
    found = serials(tmp_path, item)
    assert [(use, own) for use, own, _ in found] == expected
    assert [text for _, _, text in found] == [", ".join(own) for _, own in expected]


@pytest.mark.parametrize(
    ("item", "complaint"),
    [
        ("use: pair, serial: [1, 2, 3]", "has 3 numbers for a count of 1 of 2 items each"),
        ("use: set, serial: [1, 2]", "must have 3 numbers for pair and logger, not 2"),
        ("use: set, serial: 5", "must have 3 numbers for pair and logger, not 1"),
        ("use: set, serial: [1, 1, 2]", "lists 1 twice"),
    ],
)
def test_a_list_of_another_length_is_refused(tmp_path, item, complaint):
    with pytest.raises(InputError, match=complaint):
        serials(tmp_path, item)


def test_two_pairs_with_one_number_are_warned_of(tmp_path):
    path = tmp_path / "m.yaml"
    item = "use: pair, serial: [1, 2]}\n  - {use: pair, serial: [3, 2]"
    path.write_text(FILE.format(item=item), encoding="utf-8")
    warnings = load(path).solve().warnings
    assert any("the same serial number, 2." in one for one in warnings)
