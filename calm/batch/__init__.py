"""Many cases of one mooring: every profile of a record."""
