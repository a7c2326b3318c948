"""``calm catalog``: search and check the component catalogue."""

from __future__ import annotations

import json as json_module
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import App, Parameter

from calm.cli.outputs import ExitCode, narrate, show, show_parts
from calm.errors import InputError, UsageError

if TYPE_CHECKING:
    from calm.files import Catalogue
    from calm.files.catalogue import Defined

catalog = App(
    name="catalog",
    help="Search, show, add to and check the component catalogue.",
    help_epilogue="""Examples:

  calm catalog list --kind chain
  calm catalog list steel sphere
  calm catalog list 8mm wire "breaking>30kN"
  calm catalog show glass-17in
  calm catalog add our-glass kind=sphere role=float "diameter=432 mm" "buoyancy=250 N" source=tank
  calm catalog check mine.yaml""",
)

Kind = Literal["sphere", "cylinder", "body", "profiler", "cable", "chain", "anchor", "assembly"]


@catalog.command(
    name="list", synonym=("search", "find"), usage="Usage: calm catalog list [OPTIONS] [WORD...]"
)
def list_components(
    words: list[str] | None = None, /, *, kind: Kind | None = None, json: bool = False
) -> ExitCode:
    """List all components by family, or the components that match every word.

    Among the matches, favourites and components recently used in the line builder
    come first, followed by components used in the shipped lines. Misspelt words
    are corrected. If no component matches every word, the best matches are
    listed.

    Parameters
    ----------
    words
        Words, or parts of words, in the id, name, manufacturer, trade name, material or source.
        Sizes in millimetres or inches (`8mm wire`, `17in glass`) and limits (`breaking>50kN`,
        `net<-100`, `depth>=6000`) are allowed, too.
    kind
        Only components of one kind.
    json
        Print JSON: objects with every field, in SI units and degrees.
    """
    catalogue = _load()
    if words:
        return _show(catalogue, _search(catalogue, " ".join(words), kind), json)
    every = catalogue.all().items()
    return _show(catalogue, {id: each for id, each in every if kind in (None, each.kind)}, json)


def _search(catalogue: Catalogue, text: str, kind: str | None) -> dict[str, Defined]:
    from calm.assemble.catalogue_search import Index
    from calm.files.editing.user_state import Remembered

    index, remembered = Index(catalogue), Remembered()
    kinds = None if kind is None else [kind]
    spelt = index.spelt(text)
    if spelt != text:
        narrate(f"no component matches `{text}`; showing matches for `{spelt}`")
    first = [*remembered.favourites, *remembered.recent]
    found = index.search(spelt, kinds, first=first)
    if not found:
        found, unknown = index.nearly(spelt, kinds, first=first)
        if not found:
            narrate(f"no component matches `{spelt}`; define one with `calm catalog add`")
            return {}
        without = (
            (f", and none matches {' or '.join(f'`{word}`' for word in unknown)}")
            if unknown
            else ""
        )
        narrate(f"no component matches all words of `{spelt}`{without}; these match most of them:")
    return {each.id: catalogue.get(each.id) for each in found}


@catalog.command(name="show", usage="Usage: calm catalog show [OPTIONS] ID...")
def show_components(ids: list[str], /, *, json: bool = False) -> ExitCode:
    """Show all values of components with their sources, and derived values.

    Derived values are the net force in water, and the drag at 1 m/s across the
    axis (Kn) and along the axis (Kt). Entries for the same item from different
    sources are shown side by side, with the recommended entry first.

    Parameters
    ----------
    ids
        Ids of components, as printed by `calm catalog list`.
    json
        Print JSON: objects with every field, in SI units and degrees.
    """
    catalogue = _load()
    chosen: dict[str, Defined] = {}
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


@catalog.command(usage="Usage: calm catalog add [OPTIONS] ID KEY=VALUE...")
def add(
    id: str, figures: list[str], /, *, output: Annotated[Path | None, Parameter(alias="-o")] = None
) -> ExitCode:
    """Add a component to your own catalogue, which every command reads, and show
    its card.

    As in `calm catalog check`, impossible values and values without a source are
    rejected, and missing values that the design check needs are listed.

    Parameters
    ----------
    id
        Id of the component: lower-case letters, digits and hyphens. The component
        replaces a catalogue entry with the same id.
    figures
        The `kind` and the values with their units, such as `diameter=432 mm`, in quotes if they
        contain a space. The manual's page on components lists the keys of each kind.
    output
        Catalogue file to which the component is added; by default, your own catalogue.
    """
    from calm.checks.catalogue_rules import check_catalogue, missing_figures
    from calm.errors import Problem
    from calm.files.catalogue import defined, read_level, tidy_id, user_folder
    from calm.report import component_cards, folder
    from calm.whole_file import read_text

    if tidy_id(id) != id:
        raise UsageError(
            "an id must contain only lower-case letters, digits and hyphens; did you mean "
            f"`{tidy_id(id)}`?"
        )
    pairs = [figure.partition("=") for figure in figures]
    if bare := [key for key, equals, _ in pairs if not equals]:
        raise UsageError(
            f"values must be written KEY=VALUE, in quotes if they contain spaces: {', '.join(bare)}"
        )
    values = {key.strip(): value.strip() for key, _, value in pairs}
    path = output or user_folder() / "own.yaml"
    if output is None:
        path.parent.mkdir(parents=True, exist_ok=True)
    folder.check_destination(path)
    catalogue, problems = _load(), list[Problem]()
    own = read_level([path], problems) if path.exists() else {}
    if id in own:
        raise UsageError(f"`{id}` is defined already, in {own[id].place}; change it there")
    component, wrong = defined(id, values)
    definitions = {} if component is None else {id: component}
    messages = [each.message for each in wrong]
    messages += [each.message for each in check_catalogue(definitions, [*catalogue.ids(), id])]
    problems += [Problem(id, 0, 0, message) for message in messages]
    if problems or component is None:
        raise InputError(problems)
    before = f"{read_text(path).rstrip()}\n\n" if own else ""
    lines = [
        f"  {key}: {json_module.dumps(each, ensure_ascii=False)}" for key, each in values.items()
    ]
    folder.write_file(path, "\n".join([f"{before}{id}:", *lines, ""]).encode())
    narrate(
        f"{id} added to {path}"
        + (", where it overrides the entry of the catalogue" * bool(catalogue.entry(id)))
    )
    for each in missing_figures(definitions):
        narrate(f"{each.id}: {component_cards.in_words(each)}")
    show_parts(component_cards.to_card(id, component, catalogue))
    return ExitCode.DONE


@catalog.command(usage="Usage: calm catalog check [OPTIONS] [FILE]")
def check(file: Path | None = None, /, *, json: bool = False) -> ExitCode:
    """Find impossible and missing values in a catalogue.

    Examples of impossible values are a sphere with more buoyancy than its volume
    allows, a rope heavier than a solid bar of its diameter, and a cable stiffer
    than steel. Values without a source are findings, too. The exit code is 1 if
    there is a finding.

    Missing values that a design check or the total mass needs are listed, but are
    not findings. Values that are known to be unpublished are marked.

    Parameters
    ----------
    file
        A catalogue file; by default the shipped catalogue and your own files.
    json
        Print JSON: a list of objects with `id`, `finding` (true or false), `message`, `missing` and
        `searched`.
    """
    from calm.checks.catalogue_rules import check_catalogue, missing_figures
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


def _show(catalogue: Catalogue, definitions: Mapping[str, Defined], as_json: bool) -> ExitCode:
    from calm.report.component_cards import to_documents, to_list

    if as_json:
        show(_json(to_documents(catalogue, definitions)))
    elif definitions:
        show_parts(to_list(catalogue, definitions))
    return ExitCode.DONE


def _json(documents: list[dict[str, object]]) -> str:
    return json_module.dumps(documents, indent=2) + "\n"
