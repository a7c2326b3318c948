"""What is unknown in a mooring and how it is found. Arrays in, `Solution` out."""

from calm.solve.fit import fit_length as fit_length
from calm.solve.mooring import solve_mooring as solve_mooring
from calm.solve.solution import Settings as Settings
from calm.solve.solution import Solution as Solution
from calm.solve.status import Status as Status
