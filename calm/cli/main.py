"""The command ``calm``: its verbs, and how every error becomes one line and an exit code."""

from __future__ import annotations

import atexit
import gc
import os
import re
import sys
import traceback
import warnings
from collections.abc import Callable, Sequence
from inspect import cleandoc
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import App, CycloptsError, Group, Parameter, UnusedCliTokensError

from calm.cli import at_sea, designs, exchange, starter
from calm.cli.batch import batch
from calm.cli.catalog import catalog
from calm.cli.chart import chart
from calm.cli.check import check
from calm.cli.motion import grid, motion
from calm.cli.outputs import ExitCode, narrate, prepare, show
from calm.cli.run import run
from calm.cli.tow import strumming, tow
from calm.cli.verify import verify
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

_VALUES = {
    "FILE|-": "json csv netcdf",
    "FILE": "html pdf plot catalog currents pressures sea-level onto against update scatter "
    "elements",
    "DIR": "report",
    "NAME": "environment",
    "LABEL,...": "hold-out",
    "LAT,LON": "at near",
    "LENGTH": "diameter streamed length distance",
    "DEPTH": "depth transducer",
    "HEIGHT": "above-seabed height hs swell",
    "ANGLE": "angle course declination toward phi-a phi-b",
    "SPEED": "speed ship-speed",
    "RANGE": "speeds",
    "CONDITION": "target",
    "CHANGE": "change",
    "FLAGS": "flags",
    "WORD": "match format to method",
    "WORD,...": "fit variables",
    "LEVELS": "levels",
    "VALUE": "between",
    "SPEED|FILE": "sound-speed",
    "COLUMNS": "columns",
    "NUMBER": "port gamma k cd",
    "A/B": "time",
    "TIME": "deck-time gap step tp swell-tp duration",
    "COUNT": "samples workers",
    "N": "every seed",
    "ADDRESS": "scheduler",
    "DENSITY": "density solid-density",
    "N/m": "weight",
    "FORCE": "tension-a tension-b",
    "UNITS": "units",
    "WORD|FILE": "spectrum",
    "NAME=VALUE": "define",
}
"""What stands for the value of an option in `--help`; an option not listed tells its type."""

_VALUE_OF = {f"--{name}": value for value, names in _VALUES.items() for name in names.split()}


class HelpAtWidth:
    """Sets `--help` to the width of the terminal, and says what the value of each option is."""

    def __call__(self, console: Console, options: ConsoleOptions, panel: HelpPanel) -> None:
        """Print a panel; texts of options lose their line breaks."""
        from cyclopts.help import DefaultFormatter
        from rich.text import Text

        for place, entry in enumerate(panel.entries):
            written = getattr(entry.description, "primary_renderable", None)
            if isinstance(written, Text):
                entry.description.primary_renderable = Text(" ".join(written.plain.split()))
            value = next((_VALUE_OF[name] for name in entry.names if name in _VALUE_OF), None)
            if value and entry.metavar:
                several = "..." if entry.metavar.endswith("...") else ""
                panel.entries[place] = entry.copy(metavar=f"{value}{several}")
        DefaultFormatter()(console, options, panel)

    def render_usage(self, console: Console, options: ConsoleOptions, usage: Any) -> None:
        """Print the line of usage, with what each option wants in place of its type."""
        from cyclopts.help import DefaultFormatter

        known = re.compile(r"(--[\w-]+) ([A-Z]+)")
        text = known.sub(lambda m: f"{m[1]} {_VALUE_OF.get(m[1], m[2])}", str(usage))
        DefaultFormatter().render_usage(console, options, text)


def _examples(command: Callable[..., object]) -> str:
    """The section of a docstring that ends it, as `--help` has it."""
    text = cleandoc(command.__doc__ or "").partition("Examples\n--------\n")[2]
    return f"Examples:\n\n{text}"


def _version() -> str:
    from calm.version import __version__, built_from

    commit = built_from()
    return f"{__version__} (commit {commit})" if commit else __version__


# The file of an autoloaded function runs at the first Tab; one that is sourced names its function.
_ZSH_CALL = '\n\nif [ "$funcstack[1]" = _calm ]; then _calm "$@"; else compdef _calm calm; fi\n'


def completion(shell: Literal["bash", "zsh", "fish"], /) -> ExitCode:
    """Print a script that lets a shell complete commands and options.

    Parameters
    ----------
    shell
        The shell that reads it.

    Examples
    --------
      calm completion bash > ~/.local/share/bash-completion/completions/calm
      calm completion zsh > "${fpath[1]}/_calm"
      calm completion fish > ~/.config/fish/completions/calm.fish
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
    default_parameter=Parameter(negative=(), show_default=False, json_list=False, json_dict=False),
    suppress_keyboard_interrupt=False,
    result_action="return_value",
)
_TOW = App(
    name="tow",
    usage="Usage: calm tow [OPTIONS] FILE...\n       calm tow strumming [OPTIONS]",
    help_epilogue=_examples(tow),
)
_TOW.default(tow)
_TOW.command(strumming, help_epilogue=_examples(strumming))

_GROUPS: dict[str, tuple[tuple[Any, str], ...]] = {
    "Design": (
        (starter.new, ""),
        (starter.build, ""),
        (run, "[OPTIONS] FILE..."),
        (designs.size, ""),
        (designs.waves, ""),
        (check, "[OPTIONS] FILE..."),
        (designs.diff, "[OPTIONS] FILE [FILE]"),
    ),
    "At sea": ((at_sea.deck, "[OPTIONS] FILE..."), (at_sea.locate, "[OPTIONS] FILE")),
    "Records": ((batch, ""), (motion, ""), (grid, "[OPTIONS] DEPTHS VALUES...")),
    "Files": (
        (exchange.import_, "[OPTIONS] FILE..."),
        (exchange.export, ""),
        (catalog, ""),
        (starter.schema, ""),
    ),
    "More": (
        (_TOW, ""),
        (chart, ""),
        (verify, "[OPTIONS] [WORD...]"),
        (starter.docs, "[OPTIONS] [PAGE]"),
        (completion, "SHELL"),
    ),
}
"""The commands by what they are for, in the order of `--help`: each with its usage, where that is
not the one made from its options."""

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
            help_epilogue=_examples(_command),
        )  # fmt: skip
app["--help"].group = app["--version"].group = Group("Options", sort_key=len(_GROUPS))


@app.command(name="strumming", show=False)
def _strumming(*words: Annotated[str, Parameter(allow_leading_hyphen=True)]) -> Any:
    """Run `calm tow strumming`, which was `calm strumming` before."""
    narrate(
        "calm strumming is now calm tow strumming; the old name will be removed in the next version"
    )
    return app(["tow", "strumming", *words], exit_on_error=False, print_error=False)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command line.

    Parameters
    ----------
    arguments : the words after ``calm``; those of the process when absent

    Returns
    -------
    int
        An `ExitCode`. Whatever happens, no traceback is printed, unless the environment variable
        CALM_DEBUG is 1.
    """
    prepare()
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")  # to look for them takes time
    if arguments is None:
        gc.set_threshold(_SELDOM)
        atexit.register(gc.freeze)  # what is left needs no last search for cycles
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
