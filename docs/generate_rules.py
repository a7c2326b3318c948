"""Write the table of the rules of the design check into `docs/reference/check.md`.

python docs/generate_rules.py            # write it
python docs/generate_rules.py --check    # exit 1 if it is out of date
"""

import sys
from pathlib import Path

from calm.files.rule_texts import RULES

PAGE = Path(__file__).parent / "reference" / "check.md"
BEGIN, END = "<!-- rules -->\n", "<!-- rules end -->\n"


def table() -> str:
    """A row for each rule, in the order in which a design is reported."""
    rows = [
        f"| `{name}` | {text.judges} | {text.limit} | {text.source} |"
        for name, text in RULES.items()
    ]
    heads = ["| rule | judged | limit | source |", "| --- | --- | --- | --- |"]
    return "\n".join([*heads, *rows]) + "\n"


def page() -> str:
    """Text of the page with the new table inserted."""
    text = PAGE.read_text(encoding="utf-8")
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}{table()}{END}{after}"


if __name__ == "__main__":
    if sys.argv[1:] == ["--check"]:
        if PAGE.read_text(encoding="utf-8") != page():
            sys.exit(f"{PAGE} is out of date; run python docs/generate_rules.py")
    else:
        PAGE.write_text(page(), encoding="utf-8")
