"""The one path from a file to a result: read, assemble, solve, check. Every command takes it."""

from calm.case.mooring import Mooring as Mooring
from calm.case.net import load as load
from calm.case.result import Result as Result
from calm.case.tow import Tow as Tow
from calm.case.tow import TowResult as TowResult
