"""Output of results as tables, documents and plots."""
