"""Key `waves:` of an environment: a design sea state, a table of sea states, or a spectrum."""

from __future__ import annotations

import os.path
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Self

from pydantic import model_validator

from calm.errors import InputError, UsageError, nearest, shown
from calm.files.definition import Model, QuantityField, Text, described, optional
from calm.files.water import Toward
from calm.files.yaml_document import SourceMapping
from calm.records.sea_states import (
    OF_HEIGHT,
    SPECTRA,
    SeaState,
    measured_spectrum,
    scatter_states,
    spectrum_of,
    with_swell,
)


class SwellKeys(Model):
    """Keys of `swell:`, which describe a swell in addition to the wind sea."""

    significant_height: Annotated[float, QuantityField("length", above=0)] = described(
        "Hs of the swell", "2 m"
    )
    peak_period: Annotated[float, QuantityField("time", above=0)] = described(
        "Tp of the swell, longer than the Tp of the wind sea", "14 s"
    )


class WaveKeys(Model):
    """Keys of `waves:`, which give a design sea state, a scatter table of sea states, or both."""

    significant_height: Annotated[float | None, QuantityField("length", at_least=0.05)] = optional(
        "Hs of the design sea state", "5 m"
    )
    peak_period: Annotated[float | None, QuantityField("time", above=0)] = optional(
        "Tp of the design sea state; not for pierson-moskowitz and ochi-hubble", "8.4 s"
    )
    spectrum: Text = described(
        f"{', '.join(SPECTRA)}, or a CSV or NetCDF file with a measured spectrum",
        "jonswap",
        default="bretschneider",
    )
    gamma: Annotated[float, QuantityField("number", at_least=1, at_most=10)] = described(
        "peakedness of jonswap", 3.3, default=3.3
    )
    toward: Toward = described(
        "direction towards which the waves travel, clockwise from north", "90 deg", default=90.0
    )
    swell: SwellKeys | None = optional(
        "swell in the same direction", {"significant_height": "2 m", "peak_period": "14 s"}
    )
    scatter: Text | None = optional(
        "CSV file with the columns significant_wave_height[m],peak_period[s],share; required for "
        "the fatigue life",
        "seas.csv",
    )

    @model_validator(mode="after")
    def _some_sea(self) -> Self:
        height, period, named = self.significant_height, self.peak_period, self.spectrum in SPECTRA
        if not named and (height, period) != (None, None):
            near = nearest(self.spectrum, SPECTRA)
            raise ValueError(
                f"`{shown(self.spectrum)}` is none of {', '.join(SPECTRA)}; did you mean `{near}`?"
                if near
                else "a measured `spectrum` already defines height and period; remove these keys"
            )
        if named and height is None and (self.scatter is None or period is not None):
            raise ValueError("`waves` needs `significant_height`, a `scatter` table, or both")
        if self.swell is not None and height is None:
            raise ValueError(
                "`swell` is added to a wind sea; also set the `significant_height` of the wind sea"
            )
        if height is not None and period is None and self.spectrum not in OF_HEIGHT:
            raise ValueError(f"`significant_height` needs a `peak_period` with {self.spectrum}")
        return self


def read_waves(keys: WaveKeys, section: SourceMapping, open_files: bool) -> tuple[SeaState, ...]:
    """Read the sea states of `waves:`; return an empty tuple if there are mistakes.

    Each sea state from a scatter table contains the fraction of time in which it occurs. The
    fraction of a design sea state is 0 if a scatter table is also given, and 1 otherwise. If
    `open_files` is False, the result is empty.
    """
    before = len(section.problems)
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
        suggestion = f"; did you mean `{near}`?" if near else ""
        message = f"`{name}: {shown(text)}`: {what}{suggestion}"
        section.refuse(("waves", name), message)
    if len(section.problems) > before or not open_files:
        return ()
    form = "bretschneider" if measured else keys.spectrum
    seas: list[SeaState] = []
    try:
        if "scatter" in paths:
            seas += scatter_states(paths["scatter"], form, keys.gamma)
        if keys.significant_height is not None:
            sea = spectrum_of(form, keys.significant_height, keys.peak_period, keys.gamma)
            if keys.swell is not None:
                sea = with_swell(sea, keys.swell.significant_height, keys.swell.peak_period)
            seas.append(replace(sea, share=0.0 if seas else 1.0))
        if "spectrum" in paths:
            seas.append(replace(measured_spectrum(paths["spectrum"]), share=0.0 if seas else 1.0))
    except UsageError as error:
        section.refuse(("waves",), str(error), key=True)
    except InputError as error:
        section.problems.extend(error.problems)
    return tuple(seas)
