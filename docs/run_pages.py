"""Run the commands of the tutorials and how-to pages, and update or compare their outputs.

python docs/run_pages.py                     # write outputs and pictures into all pages
python docs/run_pages.py PAGE...             # into these
python docs/run_pages.py --check [PAGE...]   # exit 1 if a page shows another output

A page runs from top to bottom in a folder with nothing but `lines/` and `docs/field/` of the
checkout:

- a block ``sh`` runs in bash; ``python`` runs, too;
- a block ``text`` right below one is what it prints on standard output, which must not be empty. A
  line `…` stands for any lines, `…` in a line for any words; writing takes the lines that begin
  as those shown;
- a block of any language below `<!-- file: NAME -->` is written to that file;
- a block ``diff`` below `<!-- edit: NAME -->` changes lines of that file, those with - to those
  with +;
- `<!-- exit: 1 -->` above a block is the exit code it ends with when that is not 0,
  `<!-- not run: REASON -->` leaves a block out;
- a picture of the page whose file a command has made, `pictures/NAME`, is kept beside the page.

Pictures are not compared: their bytes depend on the version of matplotlib.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

DOCS = Path(__file__).resolve().parent
BLOCK = re.compile(
    r"^(?:<!-- (?P<order>file|edit|exit|not run): (?P<what>[^\n]+?) -->\n+)?"
    r"^```(?P<language>\w+)\n(?P<text>.*?)^```$",
    re.MULTILINE | re.DOTALL,
)
PICTURE = re.compile(r"!\[[^\]]*\]\(pictures/([^)]+)\)")
ELISION = "…"
RUNS = "<!-- runs -->"


class PageError(Exception):
    """The output on a page differs from the output of its commands."""


@dataclass(frozen=True)
class Block:
    """A fenced block, the order in the comment above it, and the position of its text."""

    language: str
    text: str
    order: str
    what: str
    start: int
    end: int


def pages() -> list[Path]:
    """The pages that run."""
    books = (DOCS / book for book in ("tutorial", "how-to"))
    found = sorted(page for book in books for page in book.glob("*.md"))
    return [page for page in found if RUNS in page.read_text(encoding="utf-8")]


def blocks(page: str) -> list[Block]:
    """The fenced blocks of a page."""
    return [
        Block(found["language"], found["text"], found["order"] or "", found["what"] or "",
              found.start("text"), found.end("text"))
        for found in BLOCK.finditer(page)
    ]  # fmt: skip


def run(block: Block, folder: Path) -> str:
    """Run a block and return its output.

    Raises
    ------
    PageError
        The exit code differs from the one on the page.
    """
    command = ["bash", "-euo", "pipefail", "-c", block.text]
    if block.language == "python":
        command = [sys.executable, "-W", "error", "-c", block.text]
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        command,
        cwd=folder,
        env={**os.environ, "PATH": path, "COLUMNS": "100", "NO_COLOR": "1"},
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    wanted = int(block.what) if block.order == "exit" else 0
    if done.returncode != wanted:
        raise PageError(f"{block.text}ends with {done.returncode}, not {wanted}:\n{done.stderr}")
    return "\n".join(line.rstrip() for line in done.stdout.strip("\n").splitlines()) + "\n"


def edit(block: Block, file: Path) -> None:
    """Apply a diff block to a file.

    Raises
    ------
    PageError
        The lines to change are not there, or not once.
    """
    lines = block.text.splitlines()
    old = "".join(f"{line[1:]}\n" for line in lines if line[0] in "- ")
    new = "".join(f"{line[1:]}\n" for line in lines if line[0] in "+ ")
    text = file.read_text(encoding="utf-8")
    if text.count(old) != 1:
        raise PageError(f"{file.name} has {text.count(old)} times:\n{old}")
    file.write_text(text.replace(old, new), encoding="utf-8")


def agrees(shown: str, printed: str) -> bool:
    """Whether the output on a page, with its elisions, agrees with the printed output."""
    # "(?s:.*)" for a line that is an elision, ".*" for one within a line
    lines = [
        "(?:.*\n)*"
        if line.strip() == ELISION
        else ".*".join(map(re.escape, line.split(ELISION))) + "\n"
        for line in shown.splitlines()
    ]
    return re.fullmatch("".join(lines), printed) is not None


def renewed(shown: str, printed: str) -> str:
    """New output to show: the lines that begin like the lines shown before, or all lines."""
    if ELISION not in shown:
        return printed
    rest, now = printed.splitlines(keepends=True), []
    for line in shown.splitlines(keepends=True):
        if line.strip() == ELISION:
            now.append(line)
            continue
        found = [number for number, candidate in enumerate(rest) if stem(candidate) == stem(line)]
        if not found:
            return printed
        now.append(line if agrees(line, rest[found[0]]) else rest[found[0]])
        rest = rest[found[0] + 1 :]
    return "".join(now) or printed


def stem(line: str) -> str:
    """Start of a line, up to its first number."""
    return re.split(r"[\d…]", line)[0].rstrip()


def follow(page: Path, *, check: bool) -> None:
    """Run a page.

    Raises
    ------
    PageError
        A command fails or prints nothing above a block ``text``, or, with `check`, shows something
        else than the page.
    """
    text = page.read_text(encoding="utf-8")
    changes: list[tuple[Block, str]] = []
    with tempfile.TemporaryDirectory() as name:
        folder, printed, below = Path(name), "", -1
        (folder / "lines").symlink_to(DOCS.parent / "lines")
        (folder / "docs").mkdir()
        (folder / "docs" / "field").symlink_to(DOCS / "field")
        for block in blocks(text):
            if block.order == "file":
                (folder / block.what).write_text(block.text, encoding="utf-8")
            elif block.order == "edit":
                edit(block, folder / block.what)
            elif block.order == "not run":
                continue
            elif block.language in ("sh", "python"):
                printed, below = run(block, folder), block.end + len("```\n")
            elif (
                block.language == "text"
                and not text[below : block.start - len("```text\n")].strip()
            ):
                if not printed.strip():
                    raise PageError("a command prints nothing; leave out the block below it")
                if not agrees(block.text, printed):
                    changes.append((block, printed))
        if check and changes:
            raise PageError(
                "".join(f"shown:\n{block.text}printed:\n{printed}" for block, printed in changes)
            )
        for block, printed in reversed(changes):
            text = text[: block.start] + renewed(block.text, printed) + text[block.end :]
        keep_pictures(page, text, folder, check=check)
    if changes:
        page.write_text(text, encoding="utf-8")


def keep_pictures(page: Path, text: str, folder: Path, *, check: bool) -> None:
    """Copy the pictures made by the commands to the folder of the page.

    Raises
    ------
    PageError
        A picture is neither made nor kept.
    """
    kept = page.parent / "pictures"
    for name in PICTURE.findall(text):
        made = folder / name
        if made.exists() and not check:
            kept.mkdir(exist_ok=True)
            shutil.copyfile(made, kept / name)
        elif not (made.exists() and (kept / name).exists()):
            raise PageError(f"no command makes the picture {name}, or it is not kept in {kept}")


def main(arguments: list[str]) -> int:
    """Run the pages named, or all."""
    check = "--check" in arguments
    chosen = [Path(name) for name in arguments if name != "--check"] or pages()
    failed = 0
    for page in chosen:
        try:
            if RUNS not in page.read_text(encoding="utf-8"):
                raise PageError(f"does not run: it has no `{RUNS}`, its commands are examples")
            follow(page, check=check)
        except PageError as error:
            failed += 1
            print(f"{page}: {error}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
