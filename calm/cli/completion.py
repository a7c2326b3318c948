"""``calm completion``: what a shell reads to complete commands, options and their values."""

from __future__ import annotations

from typing import Literal

from calm.cli.exit_codes import ExitCode
from calm.cli.streams import show

COMPLETION_EXAMPLES = """Examples:

  calm completion bash > ~/.local/share/bash-completion/completions/calm
  calm completion zsh > "${fpath[1]}/_calm"
  calm completion fish > ~/.config/fish/completions/calm.fish"""


def completion(shell: Literal["bash", "zsh", "fish"], /) -> ExitCode:
    """Print a script that lets a shell complete commands and options.

    Parameters
    ----------
    shell
        The shell that reads it.
    """
    from calm.cli.main import app

    show(app.generate_completion(prog_name="calm", shell=shell))
    return ExitCode.DONE
