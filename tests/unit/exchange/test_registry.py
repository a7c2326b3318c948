"""The register of formats: CALM's own, and those that other packages add by an entry point."""

import re
import sys
import tomllib
from pathlib import Path

import pytest

from calm.case import load
from calm.cli.export import export
from calm.cli.import_ import import_
from calm.errors import CalmError, InputError, UsageError
from calm.exchange import registry
from calm.exchange.exporting import export_file
from calm.exchange.importing import import_file

PAGE = Path(__file__).resolve().parents[3] / "docs" / "how-to" / "add-a-file-format.md"
SITE = """\
name: site
environment:
  depth: 200 m
  current: {speed: 0 m/s, toward: 90 deg}
"""


def blocks() -> dict[str, str]:
    """What the page of the manual shows, by the name of the file or the language."""
    found = re.findall(
        r"^(?:<!-- file: (\S+) -->\n)?```(\w+)\n(.*?)^```$", PAGE.read_text(), re.M | re.S
    )
    return {name or language: text for name, language, text in found}


@pytest.fixture
def formats(monkeypatch):
    """The register with CALM's own formats, which forgets what a test adds."""
    registry.file_formats()
    monkeypatch.setattr(registry, "_registered", dict(registry._registered))
    return registry


@pytest.fixture
def distribution(tmp_path, monkeypatch, formats):
    """Installs a package that adds a format, as pip would: a module, and its metadata beside it."""

    def install(module, text, **entries):
        (tmp_path / f"{module}.py").write_text(text)
        metadata = tmp_path / f"{module}-1.0.dist-info"
        metadata.mkdir()
        (metadata / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {module}\nVersion: 1.0\n")
        rows = [f"{name} = {value}" for name, value in entries.items()]
        (metadata / "entry_points.txt").write_text("\n".join(["[calm.formats]", *rows, ""]))
        monkeypatch.syspath_prepend(tmp_path)
        monkeypatch.delitem(sys.modules, module, raising=False)

    return install


@pytest.fixture
def gear(distribution, tmp_path):
    """The package of the manual's page, a list of its format and the water for it."""
    page = blocks()
    entries = tomllib.loads(page["pyproject.toml"])["project"]["entry-points"]["calm.formats"]
    distribution("institute_gear", page["institute_gear.py"], **entries)
    (tmp_path / "k12.gear").write_text(page["text"])
    (tmp_path / "site.yaml").write_text(SITE)
    return tmp_path


def imported(folder, **more):
    return import_file(
        folder / "k12.gear", folder / "k12.yaml", environment=folder / "site.yaml", **more
    )


def test_the_format_of_the_manual_is_recognised_and_read(gear):
    found = imported(gear)
    assert found.format == "gear"
    (gear / "k12.yaml").write_text(found.text)
    mooring = load(gear / "k12.yaml")
    assert [piece.component.kind for piece in mooring.file.pieces] == ["sphere", "cable", "anchor"]
    assert mooring.solve().anchor.vertical == pytest.approx(1500.0 - 140.0 * 1.5)


def test_the_format_of_the_manual_is_written_as_it_was_read(gear):
    (gear / "k12.yaml").write_text(imported(gear).text)
    exported = export_file(gear / "k12.yaml", "gear")
    assert exported.content.decode() == (gear / "k12.gear").read_text().replace("block", "anchor")
    assert exported.lost[:2] == ("the water", "drag")


def test_the_format_of_the_manual_says_what_is_wrong_with_a_line(gear):
    (gear / "k12.gear").write_text("GEAR 1\nsphere float 0.6\n")
    with pytest.raises(InputError, match=r"k12.gear:2.*a line needs kind, name, diameter"):
        imported(gear)


def test_commands_name_an_added_format_beside_their_own(gear):
    with pytest.raises(UsageError, match="none of gear, mdd, cbl, moordyn, oceanarray, moords"):
        imported(gear, format="orca")
    with pytest.raises(UsageError, match="allowed: cbl, csv, gear, mdd, moordyn"):
        export_file(gear / "k12.yaml", "orca")


def test_an_added_format_is_tried_before_any_list(gear):
    (gear / "k12.gear").write_text("GEAR 1\n,,,\n,,,\n")
    with pytest.raises(InputError, match="a line needs kind, name"):
        imported(gear)


@pytest.mark.parametrize(
    ("text", "entries", "message"),
    [
        (
            "import not_there",
            {"x": "broken_format"},
            r"`x` of broken_format cannot be loaded",
        ),
        ("", {"x": "broken_format"}, "broken_format registers no format `x`"),
        ("", {"mdd": "broken_format"}, "broken_format adds a format `mdd`, but CALM itself has"),
    ],
    ids=["does not import", "registers nothing", "takes a name"],
)
def test_a_format_that_cannot_be_had_is_told_with_its_module(
    text, entries, message, distribution, formats
):
    distribution("broken_format", text, **entries)
    with pytest.raises(CalmError, match=message):
        formats.file_formats()
    assert formats.file_format("cbl").name == "cbl"  # a format that is named needs no other


def test_a_name_is_registered_once(formats):
    formats.register_format("x", lambda content: False)
    with pytest.raises(ValueError, match="the format `x` already exists"):
        formats.register_format("x")


def test_every_format_of_calm_has_its_name_in_the_help():
    own = [registry.file_format(name) for name in registry._OWN]
    read, written = import_.__doc__, export.__doc__
    assert all(each.name in read for each in own if each.read is not None)
    assert all(f"{each.name} (" in written for each in own if each.write is not None)
