"""Mooring files and catalogues: text in, validated models in SI out. Nothing is computed here."""

from calm.files.catalogue import Assembly, Catalogue
from calm.files.components import Anchor, Body, Cable, Chain, Component, Cylinder, Sphere
from calm.files.environment import Environment, Wind
from calm.files.mooring import Checks, Clamp, MooringFile, Piece, Position, Solver
from calm.files.reader import read_mooring
from calm.files.schema import mooring_schema
from calm.files.tables import CurrentTable, DensityTable

__all__ = [
    "Anchor",
    "Assembly",
    "Body",
    "Cable",
    "Catalogue",
    "Chain",
    "Checks",
    "Clamp",
    "Component",
    "CurrentTable",
    "Cylinder",
    "DensityTable",
    "Environment",
    "MooringFile",
    "Piece",
    "Position",
    "Solver",
    "Sphere",
    "Wind",
    "mooring_schema",
    "read_mooring",
]
