"""The drag of cables and chains under the laws of friction and strumming that a file chooses."""

from __future__ import annotations

from math import pi
from typing import assert_never

from calm.files import Cable, Chain, Solver
from calm.files.components import FlexibleComponent
from calm.files.definition import CATALOGUE_DENSITY, STANDARD_GRAVITY
from calm.files.strumming import AmplitudeModel, BourgetMarichalKeys, ConstantCn, StrummingFactor
from calm.physics import drag
from calm.physics.strumming import AMPLIFICATIONS, BourgetMarichal, line_amplitude


def cable_drag(component: FlexibleComponent, solver: Solver) -> tuple[float, float]:
    """Kn and Kt of a metre of cable or chain [N/(m/s)²].

    A cable's Kn includes its strumming; under Bourget & Marichal's law it is that of a cable at
    rest, which the march raises. Pode's constant friction is Kt = Ct ½ρ Cn D. Where a cable or
    chain gives no Ct, that of this law is such that its friction is the same as under the other
    laws, Ct π/Cn: 0.012, 0.022 and 0.031 by finish.
    """
    if isinstance(component, Cable):
        usual = drag.CABLE_CN, drag.CABLE_CT[component.finish or "smooth"]
    elif isinstance(component, Chain):
        usual = drag.CHAIN_CN, drag.CHAIN_CT
    else:
        assert_never(component)
    cn = usual[0] if component.cn is None else component.cn
    ct = usual[1] if component.ct is None else component.ct
    kn, kt = drag.line_drag(component.diameter, cn, ct)
    if solver.friction == "constant":
        kt = kn * (ct * pi / usual[0] if component.ct is None else ct)
    if isinstance(component, Cable):
        cn = _strumming_cn(component, cn, solver)
        kn, _ = drag.line_drag(component.diameter, cn, ct)
    return kn, kt


def _strumming_cn(cable: Cable, cn: float, solver: Solver) -> float:
    law = solver.strumming
    if isinstance(law, StrummingFactor):
        return cn * law.factor
    if isinstance(law, ConstantCn):
        return law.cn
    if isinstance(law, BourgetMarichalKeys):
        return law.c0
    if isinstance(law, AmplitudeModel):
        amplitude = line_amplitude(_mass(cable), cable.diameter, CATALOGUE_DENSITY)
        return cn * AMPLIFICATIONS[law.name](amplitude)
    return cn


def _mass(cable: Cable) -> float:
    """Of a metre [kg/m]; where it is not given, from the weight in water and the diameter."""
    if cable.mass is not None:
        return cable.mass
    displaced = CATALOGUE_DENSITY * pi * cable.diameter**2 / 4
    return max(displaced - cable.net_buoyancy / STANDARD_GRAVITY, 0.0)


def vibration_law(solver: Solver) -> BourgetMarichal | None:
    """The law by which the Cn of cables grows as they strum; None where the file chooses none."""
    keys = solver.strumming
    if not isinstance(keys, BourgetMarichalKeys):
        return None
    return BourgetMarichal(keys.a1, keys.b1, keys.c1, rest=keys.c0, strouhal=keys.strouhal)
