"""The water: its screen, its forms and tables, and currents from files."""
