"""Currents, pressures, ranges and the like out of files: one reader of columns, one of datasets."""
