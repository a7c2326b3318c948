"""Designs of other programs, read into mooring files, and written from mooring files."""
