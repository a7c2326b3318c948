"""Convert the pieces and the environment of a mooring file to the arrays that the solver uses."""

from calm.assemble.arrays import assemble_floating as assemble_floating
from calm.assemble.arrays import assemble_line as assemble_line
from calm.assemble.arrays import assemble_water as assemble_water
from calm.assemble.arrays import with_axial_clamps as with_axial_clamps
from calm.assemble.component_forces import axial_drag_of as axial_drag_of
from calm.assemble.component_forces import drag_of as drag_of
from calm.assemble.component_forces import mass_in_air as mass_in_air
from calm.assemble.component_forces import net_buoyancy as net_buoyancy
