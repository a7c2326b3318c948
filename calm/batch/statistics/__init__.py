"""Statistics of a finished result: distributions, limits, extremes."""
