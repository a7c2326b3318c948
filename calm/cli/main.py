"""The command ``calm``: its subcommands, and conversion of errors to messages and exit codes."""

from __future__ import annotations

import atexit
import gc
import os
import re
import sys
import traceback
import warnings
from collections.abc import Sequence
from typing import Any, Literal

from cyclopts import App, CycloptsError, Group, Parameter

from calm.cli.batch import batch
from calm.cli.build import build
from calm.cli.catalog import catalog
from calm.cli.chart import chart
from calm.cli.check import check
from calm.cli.deck import deck
from calm.cli.diff import diff
from calm.cli.docs import docs
from calm.cli.export import export
from calm.cli.grid import grid
from calm.cli.help import HelpAtWidth, examples
from calm.cli.import_ import import_
from calm.cli.locate import locate
from calm.cli.mistakes import complaint
from calm.cli.motion import motion
from calm.cli.new import new
from calm.cli.outputs import ExitCode, narrate, prepare, show
from calm.cli.page import page
from calm.cli.run import run
from calm.cli.schema import schema
from calm.cli.size import size
from calm.cli.verify import verify
from calm.cli.waves import waves
from calm.errors import CalmError, InputError, NoEquilibrium, how_to_install

_EPILOGUE = """Examples:

  calm new -o mooring.yaml
  calm run mooring.yaml
  calm run --help

Exit codes: 0 done, 1 a check found something, 2 bad input or usage,
3 no equilibrium, 70 internal error, 130 interrupted."""

_GC_THRESHOLD = 100_000
"""Number of new objects after which Python collects reference cycles. With Python's default of 700,
the repeated scan of all imported objects takes a tenth of the time of a command.
"""


def _version() -> str:
    from calm.version import __version__, built_from

    commit = built_from()
    return f"{__version__} (commit {commit})" if commit else __version__


# zsh runs an autoloaded file at the first Tab; a sourced script must name its function itself.
_ZSH_CALL = '\n\nif [ "$funcstack[1]" = _calm ]; then _calm "$@"; else compdef _calm calm; fi\n'


def completion(shell: Literal["bash", "zsh", "fish"], /) -> ExitCode:
    """Print a script for shell completion of commands and options.

    Parameters
    ----------
    shell
        Shell for which the script is written.

    Examples
    --------
      calm completion bash > ~/.local/share/bash-completion/completions/calm
      calm completion zsh > "${fpath[1]}/_calm"
      calm completion fish > ~/.config/fish/completions/calm.fish
    """
    script = app.generate_completion(prog_name="calm", shell=shell)
    if shell == "zsh":  # zsh calls the function named after the file
        script = script.replace("_cyclopts_calm", "_calm").rstrip("\n") + _ZSH_CALL
    show(script)
    return ExitCode.DONE


app = App(
    name="calm",
    help="Design and analyse oceanographic moorings and tows.",
    help_epilogue=_EPILOGUE,
    help_format="plaintext",
    help_formatter=HelpAtWidth(),
    version=_version,
    default_parameter=Parameter(negative=(), show_default=False, json_list=False, json_dict=False),
    suppress_keyboard_interrupt=False,
    result_action="return_value",
)
_SYNONYMS = {"run": ("tow", "solve")}
"""Synonyms of commands; the message for a synonym suggests the command."""

_GROUPS: dict[str, tuple[tuple[Any, str], ...]] = {
    "Design": (
        (new, ""),
        (build, ""),
        (page, ""),
        (run, "[OPTIONS] FILE..."),
        (size, ""),
        (waves, ""),
        (check, "[OPTIONS] FILE..."),
        (diff, "[OPTIONS] FILE [FILE]"),
    ),
    "At sea": ((deck, "[OPTIONS] FILE..."), (locate, "[OPTIONS] FILE")),
    "Records": ((batch, ""), (motion, ""), (grid, "[OPTIONS] DEPTHS VALUES...")),
    "Files": (
        (import_, "[OPTIONS] FILE..."),
        (export, ""),
        (catalog, ""),
        (schema, ""),
    ),
    "More": (
        (chart, ""),
        (verify, "[OPTIONS] [WORD...]"),
        (docs, "[OPTIONS] [PAGE|WORD...]"),
        (completion, "SHELL"),
    ),
}
"""Commands by purpose, in the order of `--help`, each with its usage. An empty usage is generated
from the options.
"""

for _number, (_name, _commands) in enumerate(_GROUPS.items()):
    _group = Group(_name, sort_key=_number)
    for _place, (_command, _usage) in enumerate(_commands):
        if isinstance(_command, App):
            _command.group, _command.sort_key = _group, _place
            app.command(_command)
            continue
        _called = _command.__name__.rstrip("_")
        app.command(
            _command, name=_called, group=_group, sort_key=_place,
            usage=f"Usage: calm {_called} {_usage}" if _usage else None,
            help_epilogue=examples(_command), synonym=_SYNONYMS.get(_called),
        )  # fmt: skip
app["--help"].group = app["--version"].group = Group("Options", sort_key=len(_GROUPS))


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command line, and return an `ExitCode`.

    The arguments are the words after ``calm``, by default those of the process. A traceback is
    printed only if the environment variable CALM_DEBUG is 1.
    """
    prepare()
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")  # searching for plugins takes time
    # CALM's matrices are small: threads of NumPy's linear algebra only take time to start
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    if arguments is None:
        gc.set_threshold(_GC_THRESHOLD)
        atexit.register(gc.freeze)  # remaining objects need no final collection
        if not sys.warnoptions:
            warnings.simplefilter("ignore")  # warnings of libraries for programmers
    words = sys.argv[1:] if arguments is None else list(arguments)
    try:
        code = app(words, exit_on_error=False, print_error=False)
    except InputError as error:
        narrate(str(error))
        return ExitCode.BAD_INPUT
    except NoEquilibrium as error:
        narrate(f"calm: {error}")
        return ExitCode.NO_EQUILIBRIUM
    except CycloptsError as error:
        narrate(f"calm: {complaint(error)}")
        return ExitCode.BAD_INPUT
    except CalmError as error:
        # lines of a message after its first are indented
        narrate(re.sub(r"^(?! )", "calm: ", str(error), flags=re.MULTILINE))
        return ExitCode.BAD_INPUT
    except KeyboardInterrupt:
        narrate("calm: interrupted")
        return ExitCode.INTERRUPTED
    except ModuleNotFoundError as error:
        if (advice := how_to_install(error)) is None:
            return _unexpected(error)
        narrate(f"calm: {advice}")
        return ExitCode.BAD_INPUT
    except MemoryError:
        narrate("calm: not enough memory")
        return ExitCode.BAD_INPUT
    except Exception as error:
        return _unexpected(error)
    return code if isinstance(code, ExitCode) else ExitCode.DONE


def _unexpected(error: Exception) -> ExitCode:
    if os.environ.get("CALM_DEBUG") == "1":
        traceback.print_exception(error)
    narrate(f"calm: internal error ({type(error).__name__}: {error}); please report it")
    return ExitCode.INTERNAL_ERROR
