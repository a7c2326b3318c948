"""The result of a solved mooring, in the names and units of the result format.

Its ends, its anchor, its pieces, its knockdown, and its JSON object.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

from calm.case.result_tables import Clamps, Components, Shape
from calm.case.strumming import Strumming, StrummingBand, mooring_band
from calm.files import Clamp, MooringFile, Piece

if TYPE_CHECKING:
    from calm.case.mooring import Mooring
    from calm.case.profilers import ProfilerTravel
    from calm.case.tow import TowResult


def document_of(result: Result | TowResult, ends: dict[str, Any]) -> dict[str, Any]:
    """The JSON object of a result; `ends` holds what a mooring, or a tow, has at its ends."""
    from calm.version import __version__

    components, clamps = result.components.to_dicts(), result.clamps.to_dicts()
    for component in components:
        for name in ("kind", "role", "tension", "least_tension"):
            del component[name]
    parts: list[Piece | Clamp] = [*result.components.part, *result.clamps.part]
    for row, part in zip((*components, *clamps), parts, strict=True):
        if part.serial is not None:
            row["serial"] = part.serial
    document = result.file.document
    return {
        "calm": __version__,
        "name": result.name,
        **({} if document is None else {"document": document.to_dict()}),
        **{name: getattr(result, name) for name in _AS_THEY_ARE},
        "accuracy": {k: v for k, v in asdict(result.accuracy).items() if v is not None},
        **ends,
        "strumming": _known(result.strumming),
        "strumming_band": _known(result.strumming_band),
        "other_equilibrium": result.other_equilibrium,
        "components": components,
        "clamps": clamps,
        "shape": {name: column.tolist() for name, column in vars(result.shape).items()},
        "warnings": list(result.warnings),
    }


_AS_THEY_ARE = ("type", "status", "iterations", "segments", "miss", "closure")


def _known(part: Strumming | StrummingBand | None) -> dict[str, Any] | None:
    """A part of a result as a dictionary; None where there is none."""
    return None if part is None else asdict(part)


@dataclass(frozen=True)
class Accuracy:
    """The solver's own estimate of its errors.

    Of the worst of any depth or offset [m], of any tension [N], of the vertical and the horizontal
    pull on the anchor [N], and of the weight that it needs [N]; the last two None in a tow.
    """

    depth: float
    tension: float
    anchor: float | None = None
    required_weight: float | None = None


@dataclass(frozen=True)
class Top:
    """The free end: depth, offsets east and north, knockdown [m]; None where there is none.

    `used_buoyancy` is the share in use of the buoyancy that is at the surface, `reserve` the
    rest of it [N]; 1 and 0 below the surface. `draft` and `freeboard` [m] are those of a float at
    the surface whose hull is known.
    """

    depth: float
    x: float
    y: float
    knockdown: float | None
    used_buoyancy: float
    reserve: float
    draft: float | None = None
    freeboard: float | None = None


@dataclass(frozen=True)
class AnchorLoad:
    """Hold what the line does to its anchor [N]; `angle` is from the vertical [degrees].

    `required_weight` is the weight in water that holds it, `weight` what it has, `friction` its
    coefficient on the bed; `grounded_length` is the unstretched length of line on the seabed [m].
    """

    tension: float
    vertical: float
    horizontal: float
    angle: float
    required_weight: float
    weight: float
    friction: float
    grounded_length: float


class ResultForms:
    """The forms of a result in a notebook and for other libraries.

    `notebook_form` makes HTML of a result, `netcdf_form` a file; the packages above set them.
    """

    notebook_form: ClassVar[Callable[[Any], str] | None] = None
    netcdf_form: ClassVar[Callable[[Any], bytes] | None] = None

    if TYPE_CHECKING:

        @property
        def components(self) -> Components:
            """Return the pieces."""

    def to_pandas(self) -> Any:
        """Return the components as a pandas data frame."""
        return self.components.to_pandas()

    def to_xarray(self) -> Any:
        """The dataset that `calm run --netcdf` writes: components, clamps and shape, with units."""
        from io import BytesIO

        from xarray import load_dataset

        form = type(self).netcdf_form
        assert form is not None, "a mooring is read by calm.load"
        return load_dataset(BytesIO(form(self)))

    def _repr_html_(self) -> str | None:
        """The table of the line, for notebooks; None where nothing makes it."""
        form = type(self).notebook_form
        return None if form is None else form(self)


@dataclass(frozen=True, kw_only=True, repr=False)
class Solved(ResultForms):
    """Hold what every result has, whatever was solved. Depths [m], forces [N].

    `iterations` counts marches, `segments` the cuts of the final one, `miss` is the height
    of the line's end above the anchor's top, `closure` the relative force residual recomputed
    from the final coordinates. `other_depth` is that of the free end in another equilibrium that
    was found.
    """

    name: str
    type: str
    status: str
    iterations: int
    segments: int
    miss: float
    closure: float
    accuracy: Accuracy
    strumming: Strumming | None
    components: Components
    clamps: Clamps
    shape: Shape
    other_depth: float | None = None
    warnings: tuple[str, ...] = ()

    def __repr__(self) -> str:
        """Return the figures of both ends, in SI units and degrees."""
        lines = [f"{self.name}: {self.type}, {self.status}"]
        for end in ("top", "anchor", "tow_point", "body"):
            if end in vars(self):
                figures = asdict(vars(self)[end]).items()
                known = [f"{name} {value:.6g}" for name, value in figures if value is not None]
                lines.append(f"{end}: {', '.join(known)}")
        tables = f"{len(self.components)} components, {len(self.clamps)} clamps"
        return "\n".join([*lines, f"{tables}, {len(self.warnings)} warnings"])


@dataclass(frozen=True, kw_only=True, repr=False)
class Result(Solved):
    """A converged mooring. Lengths and depths [m], forces [N], angles [degrees].

    `still_shape` is the same line without current, None where that has no unique shape,
    `other_grounded_length` what lies on the seabed in another equilibrium. `profilers` are on their
    way; the rest of the result is of all of them at their upper stops.
    """

    mooring: Mooring
    top: Top
    anchor: AnchorLoad
    still_shape: Shape | None
    other_grounded_length: float = 0.0
    profilers: tuple[ProfilerTravel, ...] = ()

    @property
    def other_equilibrium(self) -> dict[str, float] | None:
        """Return where the free end is in another equilibrium, and what lies on the seabed there
        [m].
        """
        if self.other_depth is None:
            return None
        return {"depth": self.other_depth, "grounded_length": self.other_grounded_length}

    @property
    def file(self) -> MooringFile:
        """The file as read."""
        return self.mooring.file

    @cached_property
    def strumming_band(self) -> StrummingBand | None:
        """Return the same mooring with more drag on its cables; solved when first asked for."""
        still = self.still_shape
        return mooring_band(self.mooring, None if still is None else float(still.depth[0]))

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of the result format; None stands where a figure is unknown."""
        ends: dict[str, Any] = {"top": asdict(self.top), "anchor": asdict(self.anchor)}
        if self.profilers:
            ends["profilers"] = [asdict(each) for each in self.profilers]
        return document_of(self, ends)
