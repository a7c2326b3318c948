"""Figures to reproduce, each with its source, its kind and how CALM comes to it: `calm verify`.

A `Source` holds the cases that come from one place; figures are inlined, so that nothing is read
from a file. `calm.verification.published_case` defines a case.
"""

from calm.verification.anchor_drop import ANCHOR_DROP
from calm.verification.bourget_marichal import BOURGET_MARICHAL
from calm.verification.braconnot import BRACONNOT
from calm.verification.calm_paper import CALM_PAPER
from calm.verification.case import Case as Case
from calm.verification.case import CaseOutcome as CaseOutcome
from calm.verification.case import Kind as Kind
from calm.verification.case import Source as Source
from calm.verification.catenaries import CATENARIES
from calm.verification.cdms_1 import CDMS_1
from calm.verification.convergence import CONVERGENCE
from calm.verification.drag_curves import DRAG_CURVES
from calm.verification.elastic_hang import ELASTIC_HANG
from calm.verification.invariants import INVARIANTS
from calm.verification.pode import PODE
from calm.verification.s1000 import S1000
from calm.verification.sea_water import SEA_WATER
from calm.verification.strumming_factors import STRUMMING_FACTORS
from calm.verification.towed_cables import TOWED_CABLES
from calm.verification.uniform_current import UNIFORM_CURRENT
from calm.verification.villain_guillot import VILLAIN_GUILLOT
from calm.verification.watch_circle import WATCH_CIRCLE

SOURCES: tuple[Source, ...] = (
    S1000,
    CONVERGENCE,
    INVARIANTS,
    CDMS_1,
    UNIFORM_CURRENT,
    CATENARIES,
    ELASTIC_HANG,
    WATCH_CIRCLE,
    TOWED_CABLES,
    PODE,
    BRACONNOT,
    BOURGET_MARICHAL,
    VILLAIN_GUILLOT,
    DRAG_CURVES,
    STRUMMING_FACTORS,
    SEA_WATER,
    ANCHOR_DROP,
    CALM_PAPER,
)
"""Every source, the solver's own first."""
