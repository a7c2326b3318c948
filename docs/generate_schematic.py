"""Write `docs/reference/schematic.md` and its pictures from lines of `lines/`.

python docs/generate_schematic.py            # write them
python docs/generate_schematic.py --check    # exit 1 if one is out of date
"""

import sys
from pathlib import Path

import calm
from calm.drawing.schematic import schematic_svg
from calm.drawing.schematic.in_terminal import schematic_text

PAGE = Path(__file__).parent / "reference" / "schematic.md"
IMAGES = Path(__file__).with_name("images")
LINES = Path(__file__).resolve().parents[1] / "lines"
DRAWN = ("fit-top-depth", "taut-nylon-surface", "a-frame-sheared-tow")
TEXT = """# The schematic of a line

Printed by `python docs/generate_schematic.py`; do not edit.

A schematic shows the line in order from the top, not to scale. Each piece and each clamped
instrument has its label, its component and its cut length, and the depth and the height above the
seabed of its upper end.

![{first}](../images/schematic-{drawn[0]}.svg)

## In the terminal

`calm run FILE --schematic` draws the schematic above the table, even if there is no equilibrium.
The output of `calm run lines/{drawn[0]}.yaml --schematic` begins:

```text
{text}
```

| sign | part | | sign | part |
| --- | --- | --- | --- | --- |
| `(   )` | sphere | | `[:]` `[^]` `[v]` `[X]` | ADCP; looking up, down, both ways |
| `(o)` `(ooo)` | small float or glass ball; a pack | | `[\\|]>` | current meter |
| `[===]` | foam or other float | | `[#]` | CTD, temperature recorder, logger |
| `<===<` | streamlined float or towed body | | `\\_/` | sediment trap |
| `~\\___/~` | float at the surface | | `[ ]` `[x]` | other instrument, other body |
| `│` `┊` `§` | wire, rope, chain | | `[R]` `[R\\|R]` | release, pair of releases |
| `U` `8` `O` | shackle, swivel, link or ring | | `[#####]` `/###\\` | wheels or rotors, block |
| `├─[#]` | clamped on the line | | `\\__\\|__/` `---+---` | ship, helicopter |

## As a picture

```python
import calm
from calm.drawing.schematic import schematic_svg

result = calm.load("lines/{drawn[0]}.yaml").solve()
picture = schematic_svg(result.file, result)
assert picture.startswith("<svg")
```

The SVG has the size of A4. A long line is drawn smaller, and a line with more than about 60 rows
has a longer sheet, which a report divides into several sheets.

Surface moorings are drawn with the surface, and tows with their ship or helicopter:

![{second}](../images/schematic-{drawn[1]}.svg)

![{third}](../images/schematic-{drawn[2]}.svg)

## What it shows

- **Depths** are those in the current, under load. Without a result (`schematic_svg(file)`), they
  are those of the upright, unstretched line, and unknown for a tow or with a float at the surface.
- **Lengths** are cut lengths, before any load.
- **Symbols** follow the kind and the role of a component, then its id, name, note and label:
  *sediment trap*, *ADCP*, *upward*, *rope*, *wheels*. A rope is recognised by its `material`.
- **Runs** of equal balls or connectors are drawn together (`back-up glass 1–10`, `10 × 0.51` m),
  two releases in a row as a pair.
"""


def files() -> dict[Path, str]:
    """The content of every file that is written."""
    results = {name: calm.load(LINES / f"{name}.yaml").solve() for name in DRAWN}
    first = results[DRAWN[0]]
    titles = dict(
        zip(("first", "second", "third"), (r.name for r in results.values()), strict=True)
    )
    page = TEXT.format(drawn=DRAWN, text=schematic_text(first.file, first), **titles)
    pictures = {
        IMAGES / f"schematic-{name}.svg": schematic_svg(result.file, result)
        for name, result in results.items()
    }
    return {PAGE: page, **pictures}


if __name__ == "__main__":
    if sys.argv[1:] == ["--check"]:
        for path, content in files().items():
            if not path.exists() or path.read_text(encoding="utf-8") != content:
                sys.exit(f"{path} is out of date; run python docs/generate_schematic.py")
    else:
        for path, content in files().items():
            path.write_text(content, encoding="utf-8")
