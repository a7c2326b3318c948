"""Mooring Design & Dynamics: its `.mat` files, read and written."""
