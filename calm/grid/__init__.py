"""Gridding: what was measured at moving depths, put onto fixed levels with its uncertainty."""
