"""Draw `docs/images/judgement.png`, the page of a report that judges by rule, for the README.

python docs/generate_report_page.py

The extra `dev` brings what draws it. The bytes depend on the versions of the libraries, so nothing
compares them.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import pypdfium2
from PIL import Image, ImageChops

TARGET = Path(__file__).parent / "images" / "judgement.png"
LINE = Path(__file__).resolve().parents[1] / "lines" / "fit-top-depth.yaml"
HEADING = "Rules by environment"
SCALE = 2.0  # pixels in a point
MARGIN = 24  # pixels


def page(folder: Path) -> Image.Image:
    """The page of the report that has the heading, without the empty paper around it."""
    check = [sys.executable, "-m", "calm", "check", LINE, "--allow-unknown", "--report", folder]
    subprocess.run(check, check=True, stdout=subprocess.DEVNULL)
    pages = pypdfium2.PdfDocument(folder / "report.pdf")
    found = next(one for one in pages if HEADING in one.get_textpage().get_text_range())
    drawn = found.render(scale=SCALE).to_pil().convert("RGB")
    width, height = drawn.size
    edge = int(0.05 * height)  # what stands at the head and the foot of every page
    inside = drawn.crop((0, edge, width, height - edge))
    white = Image.new("RGB", inside.size, "white")
    left, top, right, bottom = ImageChops.difference(inside, white).getbbox()
    return inside.crop((left - MARGIN, max(0, top - MARGIN), right + MARGIN, bottom + MARGIN))


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        picture = page(Path(name))
    picture.quantize(256).save(TARGET, optimize=True)
