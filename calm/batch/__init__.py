"""Solutions of one mooring for many current profiles: every profile of a record."""
