"""The one path from a file to a result: read, assemble, solve, check. Every command takes it."""

from calm.case.mooring import Mooring as Mooring
from calm.case.mooring import load as load
from calm.case.result import Result as Result
