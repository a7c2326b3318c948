"""Closed-form solutions for lines and cables, which are independent of the march and validate it.

Units are SI and radians. The modules are

- `catenary`: a line in still water;
- `uniform`: weightless and heavy lines in a uniform stream, and Pode's cable functions;
- `villain_guillot`: towed cables with drag linear or quadratic in each velocity component;
- `chart`: Braconnot's charts.
"""

from calm.analytic import catenary as catenary
from calm.analytic import uniform as uniform
from calm.analytic import villain_guillot as villain_guillot
