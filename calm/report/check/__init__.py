"""The design check as people and programs read it."""
