"""What `calm motion` found: a table for people, a document for programs, a report."""
