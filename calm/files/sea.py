"""What blows over the water and runs on it: the wind and the waves of an environment."""

from __future__ import annotations

import os.path
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Self

from pydantic import Field, model_validator

from calm.errors import InputError, Problem, UsageError
from calm.files.definition import POSITIVE_LENGTH, Model, QuantityField, Text
from calm.files.yaml_document import SourceMapping
from calm.records.profile_tables import DIRECTION
from calm.records.sea_states import (
    OF_HEIGHT,
    SPECTRA,
    SeaState,
    measured_spectrum,
    scatter_states,
    spectrum_of,
)
from calm.suggestions import nearest, shown

_SPEED = QuantityField("speed", at_least=0)


class Wind(Model):
    """Wind over the water: speed [m/s], and where it blows to [degrees].

    It drives the water at the surface at `surface_drift`, a share of its own speed, and the water
    below ever less, linearly, down to `drift_depth` [m]: the seabed where it is None.
    """

    speed: Annotated[float, _SPEED] = Field(
        description="of the wind, at the height of the float", examples=["12 m/s"]
    )
    toward: Annotated[float, QuantityField(**vars(DIRECTION))] = Field(
        description="where it blows to, clockwise from north", examples=["90 deg"]
    )
    surface_drift: Annotated[float, QuantityField("number", at_least=0, at_most=0.1)] = Field(
        default=0.0,
        description="share of the wind's speed that the surface water drifts at",
        examples=["2 %"],
    )
    drift_depth: Annotated[float | None, POSITIVE_LENGTH] = Field(
        default=None, description="how deep the water that the wind drives goes", examples=["50 m"]
    )

    @model_validator(mode="after")
    def _depth_of_a_drift(self) -> Wind:
        if self.drift_depth is not None and "surface_drift" not in self.model_fields_set:
            raise ValueError("`drift_depth` needs `surface_drift`, a share of the wind's speed")
        return self


class WaveKeys(Model):
    """The keys of `waves:`: one sea, a table of seas with their shares of the time, or both."""

    significant_height: Annotated[float | None, POSITIVE_LENGTH] = Field(
        default=None, description="Hs of the sea to be survived", examples=["5 m"]
    )
    peak_period: Annotated[float | None, QuantityField("time", above=0)] = Field(
        default=None,
        description="Tp of that sea; pierson-moskowitz and ochi-hubble have their own",
        examples=["8.4 s"],
    )
    spectrum: Text = Field(
        default="bretschneider",
        description=f"{', '.join(SPECTRA)}, or a CSV or NetCDF file of a measured one",
        examples=["jonswap"],
    )
    gamma: Annotated[float, QuantityField("number", at_least=1, at_most=10)] = Field(
        default=3.3, description="peakedness of jonswap", examples=[3.3]
    )
    toward: Annotated[float, QuantityField(**vars(DIRECTION))] = Field(
        default=90.0, description="where they run, clockwise from north", examples=["90 deg"]
    )
    scatter: Text | None = Field(
        default=None,
        description="CSV: significant_wave_height[m],peak_period[s],share; fatigue needs it",
        examples=["seas.csv"],
    )

    @model_validator(mode="after")
    def _some_sea(self) -> Self:
        height, period, named = self.significant_height, self.peak_period, self.spectrum in SPECTRA
        if not named and (height, period) != (None, None):
            raise ValueError("a measured `spectrum` has its own height and period; leave them out")
        if named and height is None and (self.scatter is None or period is not None):
            raise ValueError("`waves` needs `significant_height`, a `scatter` table, or both")
        if height is not None and period is None and self.spectrum not in OF_HEIGHT:
            raise ValueError(f"`significant_height` needs a `peak_period` with {self.spectrum}")
        return self


@dataclass(frozen=True)
class WavesGiven:
    """Hold the seas of an environment, and where they run [degrees].

    Those of a scatter table have their shares of the time; one beside them has a share of 0.
    `climate` says whether there is such a table.
    """

    seas: tuple[SeaState, ...]
    toward: float
    climate: bool


def read_waves(
    keys: WaveKeys, section: SourceMapping, problems: list[Problem], open_files: bool
) -> WavesGiven | None:
    """Return the seas of `waves:`; None, with its mistakes in `problems`, if it has any.

    Parameters
    ----------
    section : the environment
    open_files : read its files, which are beside the mooring file; where not, None is returned
    """
    before = len(problems)
    measured = keys.spectrum not in SPECTRA
    files = {"scatter": keys.scatter, "spectrum": keys.spectrum if measured else None}
    paths: dict[str, Path] = {}
    for name, text in files.items():
        if text is None:
            continue
        path = Path(section.home("waves").document.path).parent / text
        if os.path.isfile(path):
            paths[name] = path
            continue
        near = nearest(text, SPECTRA) if name == "spectrum" else None
        what = "no such file" if name == "scatter" else f"neither {', '.join(SPECTRA)} nor a file"
        meant = f"; did you mean `{near}`?" if near else ""
        message = f"`{name}: {shown(text)}`: {what}{meant}"
        problems.append(section.problem(("waves", name), message))
    if len(problems) > before or not open_files:
        return None
    form = "bretschneider" if measured else keys.spectrum
    seas: list[SeaState] = []
    try:
        if "scatter" in paths:
            seas += scatter_states(paths["scatter"], form, keys.gamma)
        if keys.significant_height is not None:
            sea = spectrum_of(form, keys.significant_height, keys.peak_period, keys.gamma)
            seas.append(replace(sea, share=0.0 if seas else 1.0))
        if "spectrum" in paths:
            seas.append(replace(measured_spectrum(paths["spectrum"]), share=0.0 if seas else 1.0))
    except UsageError as error:
        problems.append(section.problem(("waves",), str(error), key=True))
    except InputError as error:
        problems.extend(error.problems)
    if len(problems) > before:
        return None
    return WavesGiven(tuple(seas), keys.toward, "scatter" in paths)
