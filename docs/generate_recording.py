"""Write `docs/images/builder.svg`, a recording of the line builder, by pressing its keys.

python docs/generate_recording.py            # write it
python docs/generate_recording.py --check    # exit 1 where the builder shows other words or figures
"""

import asyncio
import os
import re
import shutil
import sys
import tempfile
from pathlib import Path

from calm.shipped import shipped_folder
from calm.tui.app import BuildApp
from calm.tui.start import open_session

TARGET = Path(__file__).resolve().parent / "images" / "builder.svg"
SIZE = (118, 34)
LINE = "fit-top-depth"
STORY: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("A mooring, its shape, its verdict", ()),
    ("The wire below the float …", ("down", "down", "down", "down")),
    ("… and below it a component from the catalogue", ("a", *"sbe37")),
    ("It hangs in the line, and all figures follow", ("enter", "escape")),
    ("Taken back", ("u",)),
    ("A longer wire", ("up", "up", "up", "up", "l", *"520", "enter")),
    ("Tension along the line", ("3",)),
    ("The water", ("w",)),
)
SECONDS = 2.4


async def frames(folder: Path) -> list[str]:
    """The screen after each step of the story, as SVG."""
    file = folder / f"{LINE}.yaml"
    shutil.copy(shipped_folder("lines") / file.name, file)
    session, kept = open_session(file)
    app = BuildApp(session, kept=kept, environ={"TERM": "xterm-256color"})
    found = []
    async with app.run_test(size=SIZE) as pilot:

        async def settle() -> None:
            await pilot.pause()
            while not app.is_idle:
                await app.workers.wait_for_complete()
                await pilot.pause()

        for title, keys in STORY:
            await pilot.press(*keys)
            await settle()
            app.judging.ask_fully()
            await settle()
            await pilot.wait_for_scheduled_animations()
            await settle()
            found.append(app.export_screenshot(title=title))
    return found


def animated(pictures: list[str]) -> str:
    """Combine the pictures into a self-contained SVG that shows them in an endless loop."""
    total = SECONDS * len(pictures)
    share = 100.0 / len(pictures)
    size = re.search(r'viewBox="([^"]*)"', pictures[0])
    assert size is not None
    style = (
        f".frame {{ visibility: hidden; animation: show {total:g}s step-end infinite; }}\n"
        "@keyframes show { 0% { visibility: visible; } "
        f"{share:g}% {{ visibility: hidden; }} }}\n"
        + "".join(
            f".frame-{n} {{ animation-delay: {n * SECONDS:g}s; }}\n" for n in range(len(pictures))
        )
        + "@media print { .frame-0 { visibility: visible; animation: none; } }"
    )
    bodies = "".join(
        f'<g class="frame frame-{number}">{_alone(picture, number)}</g>\n'
        for number, picture in enumerate(pictures)
    )
    return (
        f'<svg viewBox="{size[1]}" xmlns="http://www.w3.org/2000/svg">\n'
        f"<title>The line builder</title>\n<style>{style}</style>\n{bodies}</svg>\n"
    )


def _alone(picture: str, number: int) -> str:
    """Content of a picture, without web fonts and with unique names."""
    picture = re.sub(r"\s*@font-face \{.*?\}", "", picture, flags=re.DOTALL)
    picture = re.sub(r"\s*<!-- Generated .*?-->", "", picture)
    picture = re.sub(r"terminal-\d+", f"t{number}", picture)
    inside = re.search(r"<svg[^>]*>(.*)</svg>", picture, flags=re.DOTALL)
    assert inside is not None
    return inside[1]


def words(svg: str) -> list[str]:
    """Text of a recording, without the signs of its frames, pictures and scroll bars."""
    return re.findall(r"[\w.+-]+", " ".join(re.findall(r"<text[^>]*>([^<]*)</text>", svg)))


def main() -> int:
    """Record, or compare the text with the previous recording; return the exit code."""
    with tempfile.TemporaryDirectory() as name:
        os.environ.update(XDG_STATE_HOME=f"{name}/state", XDG_CONFIG_HOME=f"{name}/configuration")
        os.environ.pop("NO_COLOR", None)
        os.chdir(name)
        svg = animated(asyncio.run(frames(Path(name))))
    if "--check" not in sys.argv:
        TARGET.write_text(svg, encoding="utf-8")
    elif words(svg) != words(TARGET.read_text(encoding="utf-8")):
        print(f"{TARGET.name} is out of date: python docs/generate_recording.py", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
