"""What a finished result says: distributions, limits, extremes."""
