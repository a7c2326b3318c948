"""From a mooring file to a `MooringFile`: every mistake found, or everything resolved."""

from __future__ import annotations

import os.path
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field

from calm.errors import InputError, Problem
from calm.files.catalogue import Catalogue
from calm.files.components import Anchor
from calm.files.document import Document, read_document
from calm.files.environment import Environment, read_environment
from calm.files.explain import unknown, validate
from calm.files.fields import Model, Text
from calm.files.line import LineReader, numbered
from calm.files.mooring import Checks, MooringFile, Piece, Position, Solver
from calm.files.section import Section


class MooringKeys(Model):
    """The keys at the top level of a mooring file."""

    name: Text | None = None
    description: Text | None = None
    position: Position | None = None
    environment: dict[str, Any] = Field(default_factory=dict)
    line: Annotated[tuple[Any, ...], Field(min_length=1)]
    components: dict[str, Any] | None = None
    environments: dict[str, dict[str, Any]] | None = None
    solver: Solver | None = None
    checks: Checks | None = None


class EnvironmentFileKeys(Model):
    """The keys at the top level of an environment file."""

    name: Text | None = None
    environment: dict[str, Any]


def read_mooring(
    path: str | Path,
    *,
    environment: str | Path | None = None,
    catalogs: Sequence[str | Path] = (),
) -> MooringFile:
    """Read a mooring file and all it refers to.

    Parameters
    ----------
    path : path
        The mooring file.
    environment : str or path, optional
        A variant named in the file, or an environment file; its keys replace those of the
        file's own `environment`.
    catalogs : sequence of paths
        Catalogue files that come before the user's own and the shipped ones, the last first.

    Raises
    ------
    InputError
        With every mistake found, each at its place.
    """
    problems: list[Problem] = []
    notices: list[str] = []
    catalogue = Catalogue.load(catalogs)
    top = _section(read_document(Path(path)))
    keys = validate(MooringKeys, top, problems)
    definitions = _child(top, "components")
    if definitions is not None:
        catalogue = catalogue.under(definitions, problems)
    reader = LineReader(catalogue, problems, notices)
    reader.check(definitions.data if definitions is not None else ())
    pieces = reader.read(top, "line") if isinstance(top.data.get("line"), list) else ()
    _check_line(pieces, top, problems)
    surroundings = _read_environment(top, environment, problems, notices)
    if surroundings is not None:
        _check_fit(pieces, surroundings, top, problems)
    if problems or keys is None or surroundings is None:
        raise InputError(_in_order(problems, str(path)))
    return MooringFile(
        path=str(path),
        name=keys.name or Path(path).stem,
        description=keys.description or "",
        position=keys.position,
        environment=surroundings,
        pieces=numbered(pieces),
        solver=keys.solver or Solver(),
        checks=keys.checks or Checks(),
        notices=tuple(notices),
    )


def _section(document: Document) -> Section:
    return Section.of(document, (), document.data)


def _child(section: Section, key: str) -> Section | None:
    """The mapping under a key, None where there is none."""
    return section.child(key) if isinstance(section.data.get(key), dict) else None


def _in_order(problems: list[Problem], path: str) -> list[Problem]:
    """Each problem once: those of the mooring file first, down the file."""
    once = dict.fromkeys(problems)
    return sorted(once, key=lambda one: (one.path != path, one.path, one.line, one.column))


def _check_line(pieces: Sequence[Piece], top: Section, problems: list[Problem]) -> None:
    """A line ends in its only anchor and holds one piece cut to fit at most."""
    if not pieces:
        return
    for piece in pieces[:-1]:
        if isinstance(piece.component, Anchor):
            message = f"anchor `{piece.use}` is not the last item; a line has one, at its end"
            problems.append(_at(piece, top, message))
    last_item = top.problem(("line", len(top.data["line"]) - 1), "")
    last_is_known = (last_item.line, last_item.column) == (pieces[-1].line, pieces[-1].column)
    anchored = any(isinstance(piece.component, Anchor) for piece in pieces)
    if last_is_known and not anchored and "tow" not in top.data:
        message = "the line has no anchor; its last item must be one (`kind: anchor`)"
        problems.append(top.problem(("line",), message, key=True))
    if len(pieces) == 1 and anchored and len(top.data["line"]) == 1:
        problems.append(_at(pieces[0], top, "nothing stands above the anchor"))
    fits = [piece for piece in pieces if piece.length is None]
    for piece in fits[1:]:
        message = f"only one piece can be cut to fit; line {fits[0].line} has one already"
        problems.append(_at(piece, top, message))


def _check_fit(
    pieces: Sequence[Piece], environment: Environment, top: Section, problems: list[Problem]
) -> None:
    for piece in pieces:
        if piece.fit_top_depth is not None and piece.fit_top_depth >= environment.depth:
            message = f"`top_depth` is below the seabed, {environment.depth:g} m deep"
            problems.append(_at(piece, top, message))


def _at(piece: Piece, top: Section, message: str) -> Problem:
    return Problem(top.document.path, piece.line, piece.column, message)


def _read_environment(
    top: Section, chosen: str | Path | None, problems: list[Problem], notices: list[str]
) -> Environment | None:
    """The file's own environment, or the chosen one laid over it; all variants are checked."""
    own = _child(top, "environment")
    if own is None:
        if chosen is None or "environment" in top.data:
            if "environment" not in top.data:
                problems.append(top.problem((), "`environment` is missing"))
            return None
        own = Section.of(top.document, (), {})
    variants = _child(top, "environments")
    names = [name for name in variants.data if _child(variants, name)] if variants else []
    # Each is checked by itself first, on any depth, so that mistakes are told where they are.
    any_depth = Section.of(top.document, (), {"depth": "1 m"})
    overlays = {name: variants.child(name) for name in names} if variants else {}
    for overlay in overlays.values():
        read_environment(overlay.over(any_depth), None, problems, notices, open_files=False)
    if chosen is None:
        return read_environment(own, None, problems, notices)
    read_environment(own.over(any_depth), None, problems, notices, open_files=False)
    if isinstance(chosen, str) and chosen in overlays:
        return read_environment(overlays[chosen].over(own), chosen, problems, notices)
    if isinstance(chosen, str) and not _is_file_name(chosen):
        message = unknown(f"no environment is called `{chosen}`", chosen, overlays)
        problems.append(top.problem(("environments",), message, key=True))
        return None
    try:
        document = read_document(Path(chosen))
    except InputError as error:
        problems.extend(error.problems)
        return None
    file = _section(document)
    keys = validate(EnvironmentFileKeys, file, problems)
    if keys is None:
        return None
    name = keys.name or Path(chosen).stem
    return read_environment(file.child("environment").over(own), name, problems, notices)


def _is_file_name(text: str) -> bool:
    return os.path.isfile(text) or os.sep in text or text.endswith((".yaml", ".yml"))
