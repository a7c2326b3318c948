"""Gridding: interpolation of measurements at moving depths to fixed levels, with uncertainty."""
