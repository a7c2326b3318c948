"""Solver for moored lines, nets of legs and towed lines, from arrays of pieces to a `Solution`."""

from calm.solve.fit import fit_length as fit_length
from calm.solve.fit import fit_tow_length as fit_tow_length
from calm.solve.free import FreeMotion as FreeMotion
from calm.solve.free import looped as looped
from calm.solve.free import part_of as part_of
from calm.solve.free import solve_rise as solve_rise
from calm.solve.free_search import plumb_speed as plumb_speed
from calm.solve.loading import load_line_solver as load_line_solver
from calm.solve.mooring import solve_mooring as solve_mooring
from calm.solve.solution import Settings as Settings
from calm.solve.solution import Solution as Solution
from calm.solve.solution import Status as Status
from calm.solve.tow import Towing as Towing
from calm.solve.tow import solve_tow as solve_tow
from calm.solve.two_speeds import CompiledPart as CompiledPart
from calm.solve.two_speeds import expect_many as expect_many
