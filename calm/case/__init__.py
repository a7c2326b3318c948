"""Reading, assembling, solving and checking of a file, as every command does."""

from calm.case.design import Design as Design
from calm.case.design import Result as Result
from calm.case.design import load as load
