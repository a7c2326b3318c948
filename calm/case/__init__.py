"""Read, assemble, solve and check a mooring file, for every command."""

from calm.case.design import Design as Design
from calm.case.design import Result as Result
from calm.case.design import load as load
