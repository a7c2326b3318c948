"""The line builder in the terminal: screens and widgets; `live` tells what they show."""
