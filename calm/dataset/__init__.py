"""Results as datasets by the CF conventions: their variables, and the NetCDF files they fill."""
