"""`calm build` where it cannot be."""

import pytest


def test_without_a_terminal_it_says_what_else_there_is(calm_process, write_mooring):
    done = calm_process("build", write_mooring())
    assert done.returncode == 2
    assert "needs a terminal" in done.stderr
    assert "calm page" in done.stderr
    assert done.stdout == ""


def test_a_redirected_error_output_is_named(calm, monkeypatch):
    for name in ("stdin", "stdout"):
        monkeypatch.setattr(f"sys.{name}.isatty", lambda: True, raising=False)
    done = calm("build", "m.yaml")
    assert done.code == 2
    assert "draws its screen on standard error, which is redirected" in done.err


@pytest.fixture
def in_terminal(monkeypatch):
    """As if there were one; nothing is to be opened in it."""
    monkeypatch.setenv("TEXTUAL_DRIVER", "textual.drivers.headless_driver:HeadlessDriver")
    monkeypatch.setattr("calm.tui.app.BuildApp.run", lambda _: pytest.fail("it was opened"))


@pytest.mark.usefixtures("in_terminal")
@pytest.mark.parametrize(
    ("option", "name", "told"),
    [
        ("--catalog", "none.yaml", "none.yaml: no such file"),
        ("--catalog", "broken.yaml", "broken.yaml:2:1: is not valid YAML"),
        ("--catalog", "weight.yaml", "weight.yaml:1:32: `weight: 5000` needs a unit"),
        ("--environment", "broken.yaml", "broken.yaml:2:1: is not valid YAML"),
        ("--environment", "bad.yaml", "bad.yaml:1:32: `speed: -1 m/s` must be at least 0 m/s"),
        ("--environment", "none.yaml", "none.yaml is neither a file nor an environment of m.yaml"),
        ("--environment", "strom", "m.yaml; did you mean `storm`?"),
    ],
)
def test_other_files_that_cannot_be_used_are_refused(
    calm, write_mooring, folder, option, name, told
):
    mooring = folder / write_mooring()
    uses, _, _ = mooring.read_text().partition("  weight: {kind")
    mooring.write_text(uses + "environments: {storm: {}}\n")
    (folder / "bad.yaml").write_text("environment: {current: {speed: -1 m/s, toward: 0 deg}}\n")
    (folder / "broken.yaml").write_text("a: [\n")
    (folder / "weight.yaml").write_text("weight: {kind: anchor, weight: 5000}\n")
    done = calm("build", "m.yaml", option, name)
    assert done.code == 2
    assert told in done.err


@pytest.mark.usefixtures("in_terminal")
def test_an_environment_file_is_refused_though_the_mooring_is_broken(calm, folder):
    (folder / "m.yaml").write_text("line: [\n")
    done = calm("build", "m.yaml", "--environment", "none.yaml")
    assert done.code == 2
    assert done.err == "none.yaml: no such file\n"


@pytest.mark.usefixtures("in_terminal")
def test_a_folder_that_is_not_there(calm):
    done = calm("build", "nowhere/m.yaml")
    assert done.code == 2
    assert "there is no folder" in done.err
