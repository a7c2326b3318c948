"""Draw `docs/images/judgement.png`, the page of a report that is signed, for the README.

python docs/generate_report_page.py

The extra `dev` installs the packages that draw it. The bytes depend on
the versions of the libraries, so they are not compared.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import pypdfium2
from PIL import Image

TARGET = Path(__file__).parent / "images" / "judgement.png"
LINE = Path(__file__).resolve().parents[1] / "lines" / "upward-adcp-300m.yaml"
SCALE = 1.6  # pixels in a point


def page(folder: Path) -> Image.Image:
    """The page that is signed."""
    check = [sys.executable, "-m", "calm", "check", LINE, "--report", folder]
    subprocess.run(check, check=True, stdout=subprocess.DEVNULL)
    first = pypdfium2.PdfDocument(folder / "report.pdf")[0]
    return first.render(scale=SCALE).to_pil().convert("L")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        picture = page(Path(name))
    picture.quantize(256).save(TARGET, optimize=True)
