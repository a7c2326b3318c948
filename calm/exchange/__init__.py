"""Import of designs of other programs to mooring files, and export of mooring files to them."""
