"""The sheets of the deck: on pages, and as files that a spreadsheet opens."""
