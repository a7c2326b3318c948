"""Read, assemble and solve mooring files, for all commands."""

from calm.case.design import Design as Design
from calm.case.design import Result as Result
from calm.case.design import load as load
