"""The command `cadpanel explain`."""

from __future__ import annotations

from typing import Annotated

import typer

from cadpanel.cli.glossary import GLOSSARY, Term
from cadpanel.errors import SettingsError
from cadpanel.near import near_names


def explain(
    term: Annotated[
        list[str] | None, typer.Argument(metavar="TERM", help="A word of tables, options or reports; none for a list.")
    ] = None,
) -> None:
    """Say what a word of cadpanel's tables, options and reports means.

    Exit codes: 0 it is said; 2 there is no such word.
    """
    if not term:
        typer.echo("\n".join(known.name for known in GLOSSARY))
        return
    known = meant(" ".join(term))
    typer.echo(f"{known.name}: {known.meaning}")
    if known.drawing:
        typer.echo(f"\n{known.drawing.strip(chr(10))}")


def meant(word: str) -> Term:
    """The entry for a word, whatever its case and dashes.

    Raises:
        SettingsError: there is none; the message names those that are nearly like it.
    """
    found = {_plain(name): entry for entry in GLOSSARY for name in (entry.name, *entry.also)}
    if _plain(word) not in found:
        names = [name for entry in GLOSSARY for name in (entry.name, *entry.also)]
        raise SettingsError(f"'{word}' is not explained; {near_names(word, names)}")
    return found[_plain(word)]


def _plain(word: str) -> str:
    return word.casefold().lstrip("-").replace("-", " ").replace("_", " ").strip()
