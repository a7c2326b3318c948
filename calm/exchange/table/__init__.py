"""Lists of pieces in CSV files and spreadsheets, those of moords among them."""
