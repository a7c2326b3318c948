"""Output of results for people and programs: tables, documents and plots."""
