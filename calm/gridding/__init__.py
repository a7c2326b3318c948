"""Gridding: measurements at moving depths, interpolated to fixed levels with uncertainty."""
