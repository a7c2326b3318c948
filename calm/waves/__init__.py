"""Tensions and motions of a mooring in waves, linearised about its static equilibrium."""
