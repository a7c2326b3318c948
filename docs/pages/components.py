"""The shipped catalogue as pages to browse: a table and cards for each family."""

import re
from collections.abc import Iterator

from calm.assemble.component_forces import datasheet
from calm.files import Catalogue, Component
from calm.files.catalogue import Assembly
from calm.quantities import QUANTITIES
from calm.report.blocks import Pairs
from calm.report.component_cards import to_card
from pages.markdown import code, plain, table

HEADS = ("id", "component", "net force in water", "breaking load", "Cd × area", "by")
HEAD = """# Components

The {number} components that come with CALM, by family, with every figure and its source.
[The catalogue](../catalogue.md) explains which of several similar entries to use.
`calm catalog list WORDS` searches them in a terminal.

| family | components |
| --- | ---: |
"""


def pages() -> dict[str, str]:
    """The pages by name, the list of families first."""
    catalogue = Catalogue.shipped()
    families: dict[str, dict[str, Component | Assembly]] = {}
    for identifier, definition in catalogue.all().items():
        entry = catalogue.entry(identifier)
        assert entry is not None
        families.setdefault(str(entry.family), {})[identifier] = definition
    rows = "".join(f"| [{name}]({name}.md) | {len(found)} |\n" for name, found in families.items())
    contents = "\n".join(families)
    index = HEAD.format(number=sum(map(len, families.values()))) + rows
    tree = f"\n```{{toctree}}\n:hidden:\n\n{contents}\n```\n"
    made = {name: "".join(_family(catalogue, name, found)) for name, found in families.items()}
    return {"index": index + tree, **made}


def _family(
    catalogue: Catalogue, name: str, definitions: dict[str, Component | Assembly]
) -> Iterator[str]:
    yield f"# {name.capitalize()}\n\n"
    yield table(HEADS, (_row(catalogue, *one) for one in definitions.items()), numeric=(2, 3, 4))
    for identifier, definition in definitions.items():
        yield f"\n## {identifier}\n\n"
        card = to_card(identifier, definition)
        (pairs,) = (block for block in card.blocks if isinstance(block, Pairs))
        figures = ((plain(key), plain(text)) for key, text in pairs.pairs)
        yield table((plain(definition.name or identifier), ""), figures)


def _row(catalogue: Catalogue, identifier: str, definition: Component | Assembly) -> list[str]:
    sheet = datasheet(definition, catalogue)
    metre = "/m" if definition.kind in ("cable", "chain") else ""
    load, area = definition.breaking_load, None if sheet is None else sheet.cd_area
    return [
        f"[{code(identifier)}](#{identifier})",
        plain(definition.name or ""),
        "" if sheet is None else QUANTITIES["net_buoyancy"].figure(sheet.net_buoyancy) + metre,
        "" if load is None else QUANTITIES["breaking_load"].figure(load),
        "" if area is None else QUANTITIES["cd_area"].figure(area) + metre,
        plain(re.split(r",(?![^(]*\))", definition.source or "")[0]),
    ]
