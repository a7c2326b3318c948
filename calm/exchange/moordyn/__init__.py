"""MoorDyn and MoorPy: single lines of their input files, read and written."""
