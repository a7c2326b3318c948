"""Where every part of a mooring was, from the currents and the pressures that were measured."""
