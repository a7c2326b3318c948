"""Position of an anchor from acoustic ranges measured by a ship."""

from calm.ranging.range_fit import Located as Located
from calm.ranging.range_fit import locate as locate
from calm.ranging.ranges import Sound as Sound
from calm.ranging.ranges import Survey as Survey
from calm.ranging.ranges import read_ranges as read_ranges
