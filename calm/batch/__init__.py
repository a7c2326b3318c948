"""Many cases of one mooring: every profile of a record, solved in lanes."""
