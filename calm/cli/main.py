"""The command ``calm``: its verbs, and how every error becomes one line and an exit code."""

from __future__ import annotations

import gc
import os
import sys
import traceback
import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

from cyclopts import App, CycloptsError, Parameter, UnusedCliTokensError

from calm.cli.batch import BATCH_EXAMPLES, batch
from calm.cli.build import BUILD_EXAMPLES, build
from calm.cli.catalog import catalog
from calm.cli.chart import chart
from calm.cli.check import CHECK_EXAMPLES, check
from calm.cli.deck import DECK_EXAMPLES, deck
from calm.cli.diff import DIFF_EXAMPLES, diff
from calm.cli.docs import DOCS_EXAMPLES, docs
from calm.cli.exchange import EXPORT_EXAMPLES, IMPORT_EXAMPLES, export, import_
from calm.cli.locate import LOCATE_EXAMPLES, locate
from calm.cli.motion import MOTION_EXAMPLES, motion
from calm.cli.run import RUN_EXAMPLES, run
from calm.cli.size import SIZE_EXAMPLES, size
from calm.cli.starter import NEW_EXAMPLES, SCHEMA_EXAMPLES, new, schema
from calm.cli.streams import ExitCode, narrate, prepare, show
from calm.cli.tow import STRUMMING_EXAMPLES, TOW_EXAMPLES, strumming, tow
from calm.cli.verify import VERIFY_EXAMPLES, verify
from calm.errors import CalmError, InputError, NoEquilibrium

if TYPE_CHECKING:
    from cyclopts.help import HelpPanel
    from rich.console import Console, ConsoleOptions

_EPILOGUE = """Examples:

  calm new -o mooring.yaml
  calm run mooring.yaml
  calm run --help

Exit codes: 0 done, 1 a check found something, 2 bad input or usage,
3 no equilibrium, 70 internal error, 75 a batch incomplete that the same command
finishes, 130 interrupted."""

_SELDOM = 100_000
"""New objects after which unused circles of them are looked for. Python's own 700 cost a command a
tenth of its time: what it imports is all looked through again and again."""


class HelpAtWidth:
    """Sets `--help` to the width of the terminal: texts of options lose their line breaks."""

    def __call__(self, console: Console, options: ConsoleOptions, panel: HelpPanel) -> None:
        """Print a panel."""
        from cyclopts.help import DefaultFormatter
        from rich.text import Text

        for entry in panel.entries:
            written = getattr(entry.description, "primary_renderable", None)
            if isinstance(written, Text):
                entry.description.primary_renderable = Text(" ".join(written.plain.split()))
        DefaultFormatter()(console, options, panel)

    def render_usage(self, console: Console, options: ConsoleOptions, usage: Any) -> None:
        """Print the line of usage."""
        from cyclopts.help import DefaultFormatter

        DefaultFormatter().render_usage(console, options, usage)


def _version() -> str:
    from calm.version import __version__, built_from

    commit = built_from()
    return f"{__version__} (commit {commit})" if commit else __version__


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
    script = app.generate_completion(prog_name="calm", shell=shell)
    if shell == "zsh":  # which calls the function that has the name of the file
        script = script.replace("_cyclopts_calm", "_calm").rstrip("\n") + _ZSH_CALL
    show(script)
    return ExitCode.DONE


app = App(
    name="calm",
    help="Statics of oceanographic moorings and tows: shape and tensions in a current.",
    help_epilogue=_EPILOGUE,
    help_format="plaintext",
    help_formatter=HelpAtWidth(),
    version=_version,
    default_parameter=Parameter(negative=(), show_default=False),
    suppress_keyboard_interrupt=False,
    result_action="return_value",
)
app.command(run, usage="Usage: calm run [OPTIONS] FILE...", help_epilogue=RUN_EXAMPLES)
app.command(check, usage="Usage: calm check [OPTIONS] FILE...", help_epilogue=CHECK_EXAMPLES)
app.command(deck, usage="Usage: calm deck [OPTIONS] FILE...", help_epilogue=DECK_EXAMPLES)
app.command(diff, usage="Usage: calm diff [OPTIONS] FILE [FILE]", help_epilogue=DIFF_EXAMPLES)
app.command(batch, help_epilogue=BATCH_EXAMPLES)
app.command(motion, help_epilogue=MOTION_EXAMPLES)
app.command(locate, usage="Usage: calm locate [OPTIONS] FILE", help_epilogue=LOCATE_EXAMPLES)
app.command(build, help_epilogue=BUILD_EXAMPLES)
app.command(tow, usage="Usage: calm tow [OPTIONS] FILE...", help_epilogue=TOW_EXAMPLES)
app.command(size, help_epilogue=SIZE_EXAMPLES)
app.command(
    import_,
    name="import",
    usage="Usage: calm import [OPTIONS] FILE...",
    help_epilogue=IMPORT_EXAMPLES,
)
app.command(export, help_epilogue=EXPORT_EXAMPLES)
app.command(strumming, help_epilogue=STRUMMING_EXAMPLES)
app.command(catalog)
app.command(chart)
app.command(verify, usage="Usage: calm verify [OPTIONS] [WORD...]", help_epilogue=VERIFY_EXAMPLES)
app.command(new, help_epilogue=NEW_EXAMPLES)
app.command(schema, help_epilogue=SCHEMA_EXAMPLES)
app.command(completion, usage="Usage: calm completion SHELL", help_epilogue=COMPLETION_EXAMPLES)
app.command(docs, usage="Usage: calm docs [OPTIONS] [PAGE]", help_epilogue=DOCS_EXAMPLES)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command line.

    Parameters
    ----------
    arguments : sequence of str, optional
        The words after ``calm``; those of the process when absent.

    Returns
    -------
    int
        An `ExitCode`. Whatever happens, no traceback is printed, unless the environment variable
        CALM_DEBUG is 1.
    """
    prepare()
    if arguments is None:
        gc.set_threshold(_SELDOM)
        if not sys.warnoptions:
            warnings.simplefilter("ignore")  # what libraries say to programmers
    words = sys.argv[1:] if arguments is None else list(arguments)
    try:
        code = app(words, exit_on_error=False, print_error=False)
    except InputError as error:
        narrate(str(error))
        return ExitCode.BAD_INPUT
    except NoEquilibrium as error:
        narrate(f"calm: {error}")
        return ExitCode.NO_EQUILIBRIUM
    except UnusedCliTokensError as error:
        narrate(f"calm: too many words: {' '.join(error.unused_tokens or ())}")
        return ExitCode.BAD_INPUT
    except (CycloptsError, CalmError) as error:
        narrate(f"calm: {error}")
        return ExitCode.BAD_INPUT
    except KeyboardInterrupt:
        narrate("calm: interrupted")
        return ExitCode.INTERRUPTED
    except MemoryError:
        narrate("calm: not enough memory")
        return ExitCode.BAD_INPUT
    except Exception as error:
        if os.environ.get("CALM_DEBUG") == "1":
            traceback.print_exc()
        narrate(f"calm: internal error ({type(error).__name__}: {error}); please report it")
        return ExitCode.INTERNAL_ERROR
    return code if isinstance(code, ExitCode) else ExitCode.DONE
