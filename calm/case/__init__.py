"""The one path from a file to a result: read, assemble, solve, check. Every command takes it."""

from calm.case.design import Design as Design
from calm.case.design import Result as Result
from calm.case.design import load as load
