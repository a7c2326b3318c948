"""A result as people and programs see it: tables, documents and plots."""
