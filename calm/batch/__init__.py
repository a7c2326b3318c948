"""Solution of one mooring for every current profile of a record."""
