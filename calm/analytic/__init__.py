"""Closed-form solutions for lines and cables, which are independent of the march and validate it.

`catenary`: a line in still water; `uniform`: lines in a uniform stream, without weight and heavy,
and Pode's cable functions; `villain_guillot`: towed cables whose drag is linear or quadratic in
each component of the velocity; `chart`: Braconnot's charts. All SI and
radians; each module states its equations, their range and their source.
"""

from calm.analytic import catenary as catenary
from calm.analytic import uniform as uniform
from calm.analytic import villain_guillot as villain_guillot
