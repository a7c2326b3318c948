"""Closed-form solutions for lines and cables, which are independent of the march and validate it.

Units are SI and radians. The solutions are for

- a line in still water (`catenary`);
- weightless and heavy lines in a uniform stream, and Pode's cable functions (`uniform`);
- towed cables with drag linear or quadratic in each velocity component (`villain_guillot`);
- Braconnot's charts (`chart`).
"""

from calm.analytic import catenary as catenary
from calm.analytic import uniform as uniform
from calm.analytic import villain_guillot as villain_guillot
