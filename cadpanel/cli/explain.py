"""The command `cadpanel explain`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated

import typer

from cadpanel.cli.glossary import GLOSSARY, Term
from cadpanel.cli.tables import headings
from cadpanel.errors import SettingsError
from cadpanel.near import near_names


def explain(
    context: typer.Context,
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
    known = meant(" ".join(term), dict(_options(context)))
    typer.echo(f"{known.name}: {known.meaning}")
    if known.drawing:
        typer.echo(f"\n{known.drawing.strip(chr(10))}")


def meant(word: str, options: Mapping[str, str] | None = None) -> Term:
    """The entry for a word, whatever its case and dashes; for the heading of a row the first word of it that has one.

    Args:
        word: of a table, an option or a report.
        options: what the help says of each; those that are words of the glossary are explained there.

    Raises:
        SettingsError: there is none; the message names those that are nearly like it.
    """
    terms = {_plain(name): entry for entry in GLOSSARY for name in (entry.name, *entry.also)}
    of_options = {_plain(name): Term(name=name, meaning=told) for name, told in (options or {}).items()}
    found = {**of_options, **terms}
    asked = _plain(word)
    entry = found.get(asked)
    if entry is None and asked in {_plain(form) for heading in headings() for form in (heading, heading.split(",")[0])}:
        entry = _first_within(asked, terms)
    if entry is None:
        names = [name for entry in GLOSSARY for name in (entry.name, *entry.also)]
        raise SettingsError(f"'{word}' is not explained; {near_names(word, [*names, *(options or ())])}")
    return entry


def _first_within(phrase: str, terms: Mapping[str, Term]) -> Term | None:
    """The term that comes first in a phrase, of whole words; of those that begin alike the longest."""
    places = [(f" {phrase} ".find(f" {name} "), -len(name), name) for name in terms]
    first = min((place for place in places if place[0] >= 0), default=None)
    return None if first is None else terms[first[2]]


def _options(context: typer.Context) -> Iterator[tuple[str, str]]:
    """Every option of every command, and what its help says; of those of one name what the first command says."""
    commands = getattr(context.find_root().command, "commands", {})
    for command in reversed(list(commands.values())):
        for one in getattr(command, "params", ()):
            if (told := getattr(one, "help", None)) and one.opts[0].startswith("--"):
                yield one.opts[0], told


def _plain(word: str) -> str:
    words = word.casefold().lstrip("-").replace("-", " ").replace("_", " ").replace(",", " ")
    return " ".join(words.split())
