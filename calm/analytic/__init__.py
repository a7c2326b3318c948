"""Closed-form solutions for lines and cables, which are independent of the march and validate it.

`catenary` has a line in still water. `uniform` has weightless and heavy lines in a uniform stream,
and Pode's cable functions. `villain_guillot` has towed cables with a drag that is linear or
quadratic in each velocity component. `chart` has Braconnot's charts. Units are SI and radians. Each
module states its equations, their range of validity and their source.
"""

from calm.analytic import catenary as catenary
from calm.analytic import uniform as uniform
from calm.analytic import villain_guillot as villain_guillot
