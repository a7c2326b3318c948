"""``calm completion``: what a shell reads to complete commands, options and their values."""

from __future__ import annotations

from typing import Literal

from calm.cli.exit_codes import ExitCode
from calm.cli.streams import show

COMPLETION_EXAMPLES = """Examples:

  calm completion bash > ~/.local/share/bash-completion/completions/calm
  calm completion zsh > "${fpath[1]}/_calm"
  calm completion fish > ~/.config/fish/completions/calm.fish"""


# The file of an autoloaded function runs at the first Tab; one that is sourced names its function.
_ZSH_CALL = """

if [ "$funcstack[1]" = _calm ]; then _calm "$@"; else compdef _calm calm; fi
"""


def completion(shell: Literal["bash", "zsh", "fish"], /) -> ExitCode:
    """Print a script that lets a shell complete commands and options.

    Parameters
    ----------
    shell
        The shell that reads it.
    """
    from calm.cli.main import app

    script = app.generate_completion(prog_name="calm", shell=shell)
    if shell == "zsh":  # which calls the function that has the name of the file
        script = script.replace("_cyclopts_calm", "_calm").rstrip("\n") + _ZSH_CALL
    show(script)
    return ExitCode.DONE
