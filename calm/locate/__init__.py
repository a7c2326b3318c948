"""Where an anchor stands, from acoustic ranges that a ship took about it."""

from calm.locate.range_fit import Located as Located
from calm.locate.range_fit import locate as locate
from calm.locate.ranges import Sound as Sound
from calm.locate.ranges import Survey as Survey
from calm.locate.ranges import read_ranges as read_ranges
