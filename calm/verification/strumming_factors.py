"""By how much strumming raises drag: three published fits."""

from __future__ import annotations

from functools import partial

from calm.physics.strumming import blevins, skop_griffin, vandiver
from calm.verification.case import PRINTED, Case, Kind, Source

_AMPLITUDES = (0.3, 0.5, 0.9, 1.0, 1.4)

STRUMMING_FACTORS = Source(
    "Strumming factors",
    """Cn of a line that strums over Cn at rest, from its amplitude A/D: Vandiver (1983),
1 + 1.043 (2 Y_rms/D)^0.65 with Y_rms = A/√2; Blevins (1990), 1 + 2.1 A/D; Skop, Griffin & Ramberg
(1977), 1 + 1.16 (w_r − 1)^0.65 with w_r = 1 + 2 A/D. Beyond A/D = 1 CALM holds Blevins' line, which
overshoots what Griffin et al. (1984) measured on cables at sea: Cn of 2.4 to 3.2, some 2.0 to 2.7
times that at rest, the band of all three at A/D from 0.5 to 1.""",
    tuple(
        Case(f"{name}, A/D {amplitude:g}", printed, "", 5.5e-4,
             PRINTED, partial(factor, amplitude), Kind.CLOSED_FORM)
        for name, factor, row in (
            ("Vandiver", vandiver, (1.597, 1.833, 2.220, 2.307, 2.626)),
            ("Blevins", blevins, (1.630, 2.050, 2.890, 3.100)),
            ("Skop-Griffin-Ramberg", skop_griffin, (1.832, 2.160, 2.700, 2.820, 3.265)),
        )
        for amplitude, printed in zip(_AMPLITUDES, row, strict=False)
    ),
)  # fmt: skip
