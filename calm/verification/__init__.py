"""Figures to reproduce, each with its source, its kind and how CALM comes to it: `calm verify`.

One module for each source. Its `SOURCE` holds the cases; figures are inlined, so that nothing is
read from a file. `calm.verification.case` defines a case.
"""

from calm.verification import (
    anchor_drop,
    bourget_marichal,
    braconnot,
    calm_paper,
    catenaries,
    cdms_1,
    convergence,
    drag_curves,
    elastic_hang,
    invariants,
    pode,
    s1000,
    sea_water,
    strumming_factors,
    towed_cables,
    uniform_current,
    villain_guillot,
    watch_circle,
)
from calm.verification.case import Case as Case
from calm.verification.case import Kind as Kind
from calm.verification.case import Outcome as Outcome
from calm.verification.case import Source as Source

SOURCES: tuple[Source, ...] = (
    s1000.SOURCE,
    convergence.SOURCE,
    invariants.SOURCE,
    cdms_1.SOURCE,
    uniform_current.SOURCE,
    catenaries.SOURCE,
    elastic_hang.SOURCE,
    watch_circle.SOURCE,
    towed_cables.SOURCE,
    pode.SOURCE,
    braconnot.SOURCE,
    bourget_marichal.SOURCE,
    villain_guillot.SOURCE,
    drag_curves.SOURCE,
    strumming_factors.SOURCE,
    sea_water.SOURCE,
    anchor_drop.SOURCE,
    calm_paper.SOURCE,
)
"""Every source, the solver's own first."""
