"""Import of designs from other programs, and export of mooring files to other programs."""
