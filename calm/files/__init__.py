"""Read mooring files and catalogues: from text to validated models in SI units.

No physics is computed here.
"""

from calm.files.catalogue import Assembly, Catalogue
from calm.files.check_limits import Accept, Checks, SafetyFactors
from calm.files.components import Anchor, Cable, Chain, Component, Flexible
from calm.files.environment import Environment, Fouling, Position
from calm.files.mooring_file import MooringFile, Solver, TowKeys
from calm.files.pieces import Clamp, LinePart, Piece, Place
from calm.files.reader import read_mooring
from calm.files.rigid import Body, Cylinder, Profiler, Rigid, Shaped, Sphere
from calm.files.schema import mooring_schema
from calm.files.strumming_keys import Strumming, StrummingFactor
from calm.files.uncertainty import Spread, Uncertainty
from calm.files.water import Wind
from calm.records.profile_tables import CurrentTable, DepthTable, SeaWater

__all__ = [
    "Accept", "Anchor", "Assembly", "Body", "Cable", "Catalogue", "Chain", "Checks", "Clamp",
    "Component", "CurrentTable", "Cylinder", "DepthTable", "Environment", "Flexible", "Fouling",
    "LinePart", "MooringFile", "Piece", "Place", "Position", "Profiler", "Rigid", "SafetyFactors",
    "SeaWater", "Shaped", "Solver", "Sphere", "Spread", "Strumming", "StrummingFactor", "TowKeys",
    "Uncertainty", "Wind", "mooring_schema", "read_mooring",
]  # fmt: skip
