"""The line builder in the terminal: screens and widgets; `live` computes what they show."""
