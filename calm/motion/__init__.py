"""Estimation of the motion of a mooring from measured currents and pressures."""
