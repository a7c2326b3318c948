"""Statistics of a finished batch result: distributions, limits, extremes."""
