"""Motion of a mooring: where every part of it was, from currents and pressures measured."""
