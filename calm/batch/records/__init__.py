"""Records of current: NetCDF, zarr and CSV as profiles over time."""
