"""Draw the screens of the line builder that `docs/reference/build.md` shows.

python docs/generate_build.py            # draw them
python docs/generate_build.py --check    # exit 1 if one is out of date
"""

import asyncio
import os
import re
import sys
import tempfile
from pathlib import Path

from textual.widgets import Input

from calm.tui.app import BuildApp
from calm.tui.start import open_session

IMAGES = Path(__file__).with_name("images")
LINES = Path(__file__).resolve().parents[1] / "lines"
SCREENS: dict[str, tuple[str, tuple[int, int], tuple[str, ...]]] = {
    "build-catalogue": ("upward-adcp-300m", (150, 40), ("a", *"twin", "space", *"release")),
    "build-water": ("deep-current-meters", (120, 32), ("w",)),
    "build-verdict": ("upward-adcp-300m", (110, 40), ("f6", "down")),
}
"""By the name of a picture the line that is opened, the size of the terminal, and the keys."""


async def screen(file: Path, size: tuple[int, int], keys: tuple[str, ...]) -> str:
    """The SVG of the builder after some keys, once all of the line is judged."""
    session, _ = open_session(file)
    app = BuildApp(session, environ={"TERM": "xterm-256color"})
    async with app.run_test(size=size) as pilot:

        async def settle() -> None:
            await pilot.pause()
            while not app.is_idle:
                await app.workers.wait_for_complete()
                await pilot.pause()

        await settle()
        await pilot.press(*keys)
        app.judging.ask_fully()
        await settle()
        app.screen.query(Input).set(disabled=True)  # no blinking cursor
        await settle()
        svg = app.export_screenshot(simplify=True)
    svg = re.sub(r"\s*@font-face \{.*?\}", "", svg, flags=re.DOTALL)
    svg = re.sub(r"\s*<!-- Generated .*?-->", "", svg)
    return re.sub(r"terminal-\d+", "terminal", svg)


def main() -> int:
    """Draw all pictures, or compare them with the existing files; return the exit code."""
    os.environ.pop("NO_COLOR", None)
    stale = []
    with tempfile.TemporaryDirectory() as state:
        os.environ["XDG_STATE_HOME"] = state  # no favourites of whoever draws them
        for name, (line, size, keys) in SCREENS.items():
            target = IMAGES / f"{name}.svg"
            svg = asyncio.run(screen(LINES / f"{line}.yaml", size, keys))
            if "--check" not in sys.argv:
                target.write_text(svg, encoding="utf-8")
            elif not target.exists() or target.read_text(encoding="utf-8") != svg:
                stale.append(target.name)
    for name in stale:
        print(f"{name} is out of date: python docs/generate_build.py", file=sys.stderr)
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
