"""Results as datasets with CF metadata: their variables and their NetCDF files."""
