"""`calm build` where it cannot be."""

import importlib.util
import socket

from calm.cli import build as command


def test_without_a_terminal_it_says_what_else_there_is(calm_process, write_mooring):
    done = calm_process("build", write_mooring())
    assert done.returncode == 2
    assert "needs a terminal" in done.stderr
    assert "--serve" in done.stderr
    assert done.stdout == ""


def test_without_textual_serve_it_says_how_to_get_it(calm, monkeypatch):
    monkeypatch.setattr(command, "find_spec", lambda name: None)
    done = calm("build", "--serve")
    assert done.code == 2
    assert "pip install 'calm-mooring[browser]'" in done.err


def test_a_port_that_is_none(calm):
    done = calm("build", "--serve", "--port", "70000")
    assert done.code == 2
    assert "--port: 70000" in done.err


def test_a_port_that_is_taken(calm_process, write_mooring):
    if importlib.util.find_spec("textual_serve") is None:
        return
    with socket.socket() as taken:
        taken.bind(("localhost", 0))
        taken.listen()
        port = taken.getsockname()[1]
        done = calm_process("build", write_mooring(), "--serve", "--port", port)
    assert done.returncode == 2
    assert f"port {port} cannot be used" in done.stderr


def test_a_folder_that_is_not_there(calm_process):
    done = calm_process("build", "nowhere/m.yaml", "--serve")
    assert done.returncode == 2
    assert "there is no folder" in done.stderr
