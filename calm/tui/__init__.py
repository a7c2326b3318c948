"""The line builder in the terminal: screens and widgets; `live` solves and judges the line."""
