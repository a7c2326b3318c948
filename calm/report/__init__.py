"""What people and programs are shown of a result: tables, documents and plots."""
