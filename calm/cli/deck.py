"""``calm deck``: deck sheets for the deployment."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from calm.cli import options, reading
from calm.cli.outputs import ExitCode, narrate
from calm.errors import NoEquilibrium
from calm.version import __version__

if TYPE_CHECKING:
    from calm.deck import Deck
    from calm.report.diagram import PageSize


def deck(
    files: options.MooringPaths,
    /,
    *,
    output: options.OutputFile,
    page: Literal["a4", "a3", "letter"] = "a4",
    environment: list[str] | None = None,
    order: Literal["anchor-last", "anchor-first"] = "anchor-last",
    ship_speed: str = "1 m/s",
    streamed: str | None = None,
    course: str | None = None,
    catalog: options.CatalogFiles = None,
    units: options.Units = None,
) -> ExitCode:
    """Write the deck sheets of moorings and nets, with a diagram.

    The file deck.pdf has a mooring diagram, deployment and recovery logs, cutting
    list, hardware bill, shipping list, lifts, instrument sheet and, for
    anchor-last deployment, the anchor drop plan. The diagram is also written as
    diagram.pdf and diagram.svg, the lists as CSV files and as sheets of
    deck.xlsx, and the plan as plan.json. A net is drawn as a whole and listed leg
    by leg; the drawing is also written as net.svg. A net has no anchor drop plan.

    Parameters
    ----------
    output
        Folder for the sheets. With several moorings, each gets a subfolder with its name.
    page
        Page size.
    environment
        Environment in which depths and lengths are computed: a name from the files, or an
        environment file. Repeatable: any further environments give the design currents. By default,
        depths and lengths are computed in the default environment of the file, and its named
        environments give the design currents.
    order
        Deployment order.
    ship_speed
        Speed over the ground at which the ship tows the line out before the
        anchor is released.
    streamed
        Horizontal distance from the anchor to the top float when the anchor is released. By default
        CALM computes this distance for a line that is towed at --ship-speed.
    course
        Course over the ground while the line is towed out. By default the ship steams against the
        surface current.

    Examples
    --------
      calm deck mooring.yaml -o cruise/
      calm deck mooring.yaml -o cruise/ --page a3 --environment storm
      calm deck north.yaml south.yaml -o cruise/
      calm deck mooring.yaml -o cruise/ --ship-speed "2 knot" --course "245 deg"
      calm deck shallow.yaml -o cruise/ --order anchor-first
    """
    from calm.deck import deck_items, deck_of
    from calm.report import diagram, provenance
    from calm.report.folder import check_folder

    check_folder(output)
    provenance.moment()
    ship = options.quantities(
        ship_speed=(ship_speed, "speed"),
        streamed=(streamed, "length"),
        course=(course, "angle"),
    )
    designs, tows = reading.read_designs(files, environment, catalog or [], None, "calm deck")
    if tows:
        narrate(f"Tows have no deck sheets and were skipped: {', '.join(map(str, tows))}")
    options.show_units(units, [one.file for design in designs for one in design.moorings])
    folders = _folders(designs, output)
    decks: list[Deck] = []
    for design in designs:
        for notice in dict.fromkeys(n for one in design.moorings for n in one.file.notices):
            narrate(f"{design.path}: {notice}")
        try:
            decks.append(deck_of(design.moorings, deck_items.Order(order), **ship))
        except NoEquilibrium as failure:
            narrate(f"{design.path}: {failure}")
            return ExitCode.NO_EQUILIBRIUM
    for folder, design, one in zip(folders, designs, decks, strict=True):
        _write(folder, design.path, one, diagram.PageSize(page))
    return ExitCode.DONE


def _write(folder: Path, path: Path, deck: Deck, page_size: PageSize) -> None:
    from calm.drop import DropPlan
    from calm.report.folder import write_report
    from calm.report.open_items import assessment_verdict

    narrate(
        f"{path}: design check {assessment_verdict(deck.assessment).text}; see calm check {path}"
    )
    notes = _missing_characters(deck)
    for note in (*deck.notes, *notes):
        narrate(f"{path}: {note}")
    if isinstance(deck.plan, DropPlan) and deck.plan.start is None:
        narrate(
            f"{path}: the starting point of the ship's run to the target is not computed; set "
            "`deck_time` (handling time per piece, by role) in the `document` section of the file"
        )
    write_report(folder, _contents(deck, page_size, notes))
    narrate(f"Deck sheets written to {folder}")


def _contents(deck: Deck, page_size: PageSize, notes: tuple[str, ...]) -> Mapping[str, bytes]:
    from calm.checks.finding import State
    from calm.report import deck_files, open_items, result_files
    from calm.report.diagram import diagram_svg
    from calm.report.folder import printed

    texts = {"diagram.svg": diagram_svg(deck, page_size), **deck_files.deck_csvs(deck)}
    if deck.result.several:
        texts["net.svg"] = deck_files.net_svg(deck)
    counts = open_items.open_counts(deck.assessment)
    verdict = {
        "verdict": str(deck.assessment.verdict),
        "state": str(deck.assessment.state),
        "fails": counts[State.FAIL],
        "unknown": counts[State.UNKNOWN],
        "warns": counts[State.WARN],
        "accepted": counts[State.ACCEPTED],
        "estimated": counts[State.ESTIMATED],
    }
    texts["plan.json"] = result_files.to_json(
        [{"calm": __version__, **_plan(deck), "verdict": verdict}]
    )
    return {
        "deck.pdf": printed(deck_files.deck_report(deck, page_size, notes), page_size),
        "deck.xlsx": deck_files.deck_workbook(deck),
        "diagram.pdf": printed(deck_files.diagram_report(deck, page_size), page_size),
        **{name: text.encode("utf-8", "replace") for name, text in texts.items()},
    }


def _plan(deck: Deck) -> dict[str, Any]:
    if deck.result.several:
        return {"status": "net", "message": "The anchor drop of a net is not computed."}
    if deck.plan is None:
        return {
            "status": str(deck.order),
            "message": "With anchor-first deployment there is no anchor drop.",
        }
    if isinstance(deck.plan, NoEquilibrium):
        return {"name": deck.file.name, **deck.plan.to_dict()}
    return deck.plan.to_dict()


def _missing_characters(deck: Deck) -> tuple[str, ...]:
    from calm.drawing.typesetting import lacking

    signs = lacking(text for text, _ in _printed_texts(deck))
    if not signs:
        return ()
    where = dict.fromkeys(place for text, place in _printed_texts(deck) if lacking([text]))
    named = ", ".join(f"{sign} (U+{ord(sign):04X})" for sign in signs)
    return (f"The font of the sheets lacks {named}; � is printed instead in {', '.join(where)}",)


def _printed_texts(deck: Deck) -> Iterator[tuple[str, str]]:
    from calm.report.provenance import title_pairs

    for name, text in title_pairs(deck.file):
        yield text, name
    if deck.file.document is not None:
        for revision in deck.file.document.history:
            yield f"{revision.by} {revision.change}", "history"
    for one in deck.parts:
        equipment = one.part.equipment
        texts = (one.label, one.name, one.serial, one.deployed_serial, one.remark,
                 equipment.sampling, equipment.termination)  # fmt: skip
        yield " ".join(filter(None, texts)), f"`{one.label}`"


def _folders(designs: Sequence[reading.DesignFile], output: Path) -> list[Path]:
    if len(designs) == 1:
        return [output]
    return [output / name for name in reading.names_of_files(designs, output)]
