"""``calm catalog``: look into the component catalogue, and check it."""

from __future__ import annotations

import json as json_module
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from cyclopts import App

from calm.cli.streams import ExitCode, narrate, show, show_parts
from calm.errors import UsageError

if TYPE_CHECKING:
    from calm.files import Catalogue
    from calm.report.component_cards import Definition

catalog = App(
    name="catalog",
    help="Search, show and check the component catalogue.",
    help_epilogue="""Examples:

  calm catalog list --kind chain
  calm catalog search steel sphere
  calm catalog show glass-17in
  calm catalog check mine.yaml""",
)

Kind = Literal["sphere", "cylinder", "body", "cable", "chain", "anchor", "assembly"]


@catalog.command(name="list")
def list_components(*, kind: Kind | None = None, json: bool = False) -> ExitCode:
    """List the components, family by family.

    Parameters
    ----------
    kind
        Only those of one kind.
    json
        As JSON: objects with every field, in SI units and degrees.
    """
    catalogue = _load()
    chosen = {
        identifier: definition
        for identifier, definition in catalogue.all().items()
        if kind in (None, definition.kind)
    }
    return _show(catalogue, chosen, json)


@catalog.command(usage="Usage: calm catalog search [OPTIONS] WORD...")
def search(words: list[str], /, *, json: bool = False) -> ExitCode:
    """List the components whose definition holds every word, in any case.

    Parameters
    ----------
    words
        Words or parts of words: of the id, the name, the maker, the material, the source.
    json
        As JSON: objects with every field, in SI units and degrees.
    """
    catalogue = _load()
    chosen = {identifier: catalogue.get(identifier) for identifier in catalogue.search(words)}
    if not chosen:
        narrate(f"no component has {' and '.join(words)}")
    return _show(catalogue, chosen, json)


@catalog.command(name="show", usage="Usage: calm catalog show [OPTIONS] ID...")
def show_components(ids: list[str], /, *, json: bool = False) -> ExitCode:
    """Show every figure of components, where they come from, and what follows from them.

    That is the net force in water, Kn and Kt, the drag at 1 m/s. Components that are the same item
    by different sources are shown side by side, the one to use first.

    Parameters
    ----------
    ids
        Ids of components, as `calm catalog list` gives them.
    json
        As JSON: objects with every field, in SI units and degrees.
    """
    catalogue = _load()
    chosen: dict[str, Definition] = {}
    unknown: list[str] = []
    for identifier in ids:
        try:
            chosen[identifier] = catalogue.get(identifier)
        except UsageError as error:
            unknown.append(str(error))
    if unknown:
        raise UsageError("; ".join(unknown))
    if json:
        return _show(catalogue, chosen, json)
    from calm.report.component_cards import to_card

    show_parts(*(to_card(each, definition, catalogue) for each, definition in chosen.items()))
    return ExitCode.DONE


@catalog.command(usage="Usage: calm catalog check [OPTIONS] [FILE]")
def check(file: Path | None = None, /, *, json: bool = False) -> ExitCode:
    """Find what is physically impossible in a catalogue, and list what is missing.

    A sphere that lifts more than its volume, a rope heavier than a solid bar of its diameter and a
    cable stiffer than steel are impossible; figures without a source are findings, too. The exit
    code is 1 when there is a finding.

    Missing figures are listed, but are not findings: figures without which a design check has an
    unknown, or the sum of the masses is incomplete. Figures that were searched for and not found
    are marked.

    Parameters
    ----------
    file
        A catalogue file; when not given, the whole catalogue with your own files.
    json
        As JSON: a list of objects with `id`, `finding` (true or false), `message`, `missing` and
        `searched`.
    """
    from calm.checks.catalogue_rules import check_catalogue
    from calm.checks.missing import missing_figures
    from calm.files import Catalogue
    from calm.report.component_cards import in_words, summarised, to_objects

    catalogue = Catalogue.load([file] if file else [])
    checked = Catalogue(catalogue.levels[:1]) if file else catalogue
    definitions = checked.all()
    findings = check_catalogue(definitions, known=catalogue.ids())
    missing = missing_figures(definitions)
    if json:
        show(_json(to_objects(findings, missing)))
    else:
        show("".join(f"{finding.id}: {finding.message}\n" for finding in findings))
        show("".join(f"{each.id}: {in_words(each)}\n" for each in missing))
        narrate(f"components checked: {len(definitions)}; findings: {len(findings)}")
        if missing:
            narrate(summarised(missing))
    return ExitCode.FINDING if findings else ExitCode.DONE


def _load() -> Catalogue:
    from calm.files import Catalogue

    return Catalogue.load()


def _show(catalogue: Catalogue, definitions: Mapping[str, Definition], as_json: bool) -> ExitCode:
    from calm.report.component_cards import to_documents, to_list

    if as_json:
        show(_json(to_documents(catalogue, definitions)))
    elif definitions:
        show_parts(to_list(catalogue, definitions))
    return ExitCode.DONE


def _json(documents: list[dict[str, object]]) -> str:
    return json_module.dumps(documents, indent=2) + "\n"
