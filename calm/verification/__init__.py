"""Published and independently computed values that CALM must reproduce, for `calm verify`.

Each `Source` holds the cases of one publication or derivation.
"""

from calm.verification import drag_and_sea_water
from calm.verification.cable_papers import BOURGET_MARICHAL, BRACONNOT, VILLAIN_GUILLOT
from calm.verification.march_properties import CONVERGENCE, INVARIANTS
from calm.verification.published_case import Case as Case
from calm.verification.published_case import CaseOutcome as CaseOutcome
from calm.verification.published_case import Kind as Kind
from calm.verification.published_case import Source as Source
from calm.verification.solved_moorings import CDMS_1, S1000
from calm.verification.still_water import ANCHOR_DROP, CATENARIES, ELASTIC_HANG, WATCH_CIRCLE
from calm.verification.uniform_current import PODE, TOWED_CABLES, UNIFORM_CURRENT

SOURCES: tuple[Source, ...] = (
    S1000, CONVERGENCE, INVARIANTS, CDMS_1, UNIFORM_CURRENT, CATENARIES, ELASTIC_HANG, WATCH_CIRCLE,
    TOWED_CABLES, PODE, BRACONNOT, BOURGET_MARICHAL, VILLAIN_GUILLOT,
    drag_and_sea_water.DRAG_CURVES, drag_and_sea_water.STRUMMING_FACTORS,
    drag_and_sea_water.SEA_WATER, ANCHOR_DROP, drag_and_sea_water.CALM_PAPER,
)  # fmt: skip
"""All sources, beginning with the sources about the solver itself."""
