"""Command lines and files as people type them wrongly: each gets the correct form."""

import pytest


@pytest.fixture
def named(write_mooring, folder):
    """`m.yaml`, a mooring file."""
    return folder / write_mooring()


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ("run M.yaml", "M.yaml: no such file; did you mean `m.yaml`?\n"),
        ("run m", "m: no such file; did you mean `m.yaml`?\n"),
        ("run m.yml", "m.yml: no such file; did you mean `m.yaml`?\n"),
        ("run other.yaml", "other.yaml: no such file\n"),
        ("check m.yaml --all", "unknown option --all; did you mean --all-findings or "),
        ("run m.yaml --env storm", "unknown option --env; did you mean --environment?"),
        ("run -", "CALM does not read standard input; name a file"),
        ("help run", "for the help of a command, type `calm run --help`"),
        ("new x.yaml", "For a file: -o x.yaml"),
        ("import m.yaml -o n.yaml", "is already a mooring file of CALM; solve it with: calm run m"),
    ],
)
def test_a_command_line(calm, named, words, says):
    done = calm(*words.split())
    assert (done.code, done.out) == (2, "")
    assert says in done.err
    assert len(done.err.splitlines()) == 1


@pytest.mark.parametrize(
    ("right", "wrong", "says"),
    [
        ("toward: 90 deg", "from: 270 deg", "unknown key `from`; use `toward`, and turn the dir"),
        ("toward: 90 deg", "toward: E", "did you mean `toward: 90 deg`?"),
        ("{speed: 0.5 m/s, toward: 90 deg}", "0.5 m/s", "as `current: {speed: 0.5 m/s, toward: "),
        ("{use: weight}", "use weight", "is not an item; write `{use: weight}`"),
        (
            "clamps: [{use: logger, at: 10 m}]",
            "clamps: {use: logger}",
            "as `clamps: [{use: sbe37}]`",
        ),
    ],
)
def test_a_file(calm, named, right, wrong, says):
    text = named.read_text(encoding="utf-8")
    assert right in text
    named.write_text(text.replace(right, wrong), encoding="utf-8")
    done = calm("run", "m.yaml")
    assert done.code == 2
    assert says in done.err
    assert len(done.err.splitlines()) == 1
