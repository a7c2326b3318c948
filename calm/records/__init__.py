"""Currents, pressures, ranges and other measurements out of files: one reader of columns and of datasets."""
