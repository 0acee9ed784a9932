"""The program `cadpanel`: gathers the commands, and turns what goes wrong into one sentence and an exit code."""

from __future__ import annotations

import os
import signal
import sys
import tempfile
import traceback
import warnings
from collections.abc import Callable, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Annotated, NoReturn

import typer

from cadpanel.causes import stopped_by
from cadpanel.cli.compare import compare
from cadpanel.cli.diff import diff
from cadpanel.cli.examples import epilog
from cadpanel.cli.explain import explain
from cadpanel.cli.features import features
from cadpanel.cli.fit import fit
from cadpanel.cli.freecad import freecad
from cadpanel.cli.init import init
from cadpanel.cli.inspect import inspect
from cadpanel.cli.interrupt import interrupts_stop_once
from cadpanel.cli.loft import loft
from cadpanel.cli.printable import complain, forgive_encodings, stand_in_for_closed_streams
from cadpanel.cli.run import run
from cadpanel.cli.study import study
from cadpanel.cli.verify import verify
from cadpanel.cli.view import view
from cadpanel.errors import CadpanelError, ProofError, SettingsError
from cadpanel.garbage import own_process

EXIT_NOT_HELD = 1
"""The command ran, but a tolerance or a proof does not hold."""
EXIT_REFUSED = 2
"""The input, a setting or the output folder was refused."""
EXIT_UNFORESEEN = 3
"""Something has stopped the program that nobody foresaw; its details are in a file."""
EXIT_INTERRUPTED = 130
EXIT_TERMINATED = 143

COMMANDS: tuple[Callable[..., None], ...] = (
    fit,
    init,
    run,
    compare,
    study,
    verify,
    diff,
    view,
    loft,
    features,
    inspect,
    explain,
)
"""One function a command, from a file of its own; its name is the command's, its docstring the help."""

app = typer.Typer(name="cadpanel", pretty_exceptions_enable=False)


def _show_version(asked: bool) -> None:
    if asked:
        typer.echo(f"cadpanel {version('cadpanel')}")
        raise typer.Exit


@app.callback()
def cadpanel(
    version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    """Fit developable panels to a free-form building skin and deliver them as exact solids in STEP."""
    del version  # the callback has shown it
    try:
        Path.cwd()
    except FileNotFoundError:
        raise SettingsError("the folder that this was started in no longer exists: change to another one") from None


MOST_SAID = 200
"""Characters of an error that was not foreseen, in its sentence; the rest is in the file."""

for command in COMMANDS:
    app.command(epilog=epilog(command.__name__))(command)
app.add_typer(freecad)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command.

    Args:
        arguments: the words after `cadpanel`; those of the command line if None.

    Returns:
        The exit code: 0 all is well; 1 the command ran, but a tolerance or a proof does not hold; 2 refused, with one
        sentence on stderr; 3 something that was not foreseen; 130 interrupted; 143 killed.
    """
    own_process()
    stand_in_for_closed_streams()
    forgive_encodings()
    for gone in _goodbyes():
        if signal.getsignal(gone) is not signal.SIG_IGN:  # nohup wants it ignored
            signal.signal(gone, _stop)
    try:
        with interrupts_stop_once(), warnings.catch_warnings():
            # NumPy's remarks on single operations are not for users; what comes of them is checked, and told.
            warnings.simplefilter("ignore", RuntimeWarning)
            status = app(args=arguments, prog_name="cadpanel", standalone_mode=False)
    except typer.TyperException as error:
        message = error.format_message().replace("Value error, ", "").rstrip(".")
        return _refuse(f"{message} (see 'cadpanel --help').")
    except ProofError as error:
        complain("\n".join(("The proof does not hold, and nothing was written:", *error.failures, "")))
        return EXIT_NOT_HELD
    except CadpanelError as error:
        return _refuse(str(error))
    except KeyboardInterrupt:
        status = EXIT_INTERRUPTED
    except Exception as error:  # noqa: BLE001 - the last resort: whoever sits there is told where the details are
        stopped = stopped_by(error)
        if stopped is None:
            return _unexpected(error)
        if isinstance(stopped, SystemExit):
            return EXIT_TERMINATED
        status = EXIT_INTERRUPTED
    if status == EXIT_INTERRUPTED:
        complain("Interrupted.\n")
        # An interrupt that went through Python text run by an extension, as while the kernel's binding loads, is kept
        # in mind by CPython, which then ends by the signal whatever code is returned. Running text makes it forget.
        exec("")
    return status if isinstance(status, int) else 0


def _goodbyes() -> tuple[signal.Signals, ...]:
    """The signals by which a system asks a program to end; Windows knows no terminal that hangs up."""
    names = ("SIGTERM", "SIGHUP", "SIGBREAK")
    return tuple(signal.Signals[name] for name in names if name in signal.Signals.__members__)


def _refuse(sentence: str) -> int:
    """Say it as one sentence on one line, however it was wrapped."""
    words = " ".join(sentence.split()).rstrip(".")
    complain(f"{words[:1].upper()}{words[1:]}.\n")
    return EXIT_REFUSED


def _unexpected(error: Exception) -> int:
    """Say in one sentence that an error was not foreseen, and in which file its details are."""
    handle, name = tempfile.mkstemp(prefix="cadpanel-error-", suffix=".txt", text=True)
    with os.fdopen(handle, "w", encoding="utf-8", errors="backslashreplace") as file:
        file.write(f"cadpanel {version('cadpanel')}, {sys.platform}, Python {sys.version}\n")
        file.write("".join(traceback.format_exception(error)))
    said = " ".join(str(error).split())[:MOST_SAID]
    complain(
        f"Something that was not foreseen has stopped this ({type(error).__name__}{f': {said}' if said else ''}): the "
        f"details are in '{name}'; please send that file to those who make cadpanel.\n"
    )
    return EXIT_UNFORESEEN


def _stop(_signal: int, _frame: object) -> NoReturn:
    """A polite kill, or a terminal that is closed, cleans up as an interrupt does."""
    raise SystemExit(EXIT_TERMINATED)


if __name__ == "__main__":
    sys.exit(main())
