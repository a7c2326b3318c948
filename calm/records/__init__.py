"""Readers of measurement files: currents, pressures, ranges and similar records."""
