"""Write the tables of options into the page `examples/reference.md`, from the commands themselves.

python examples/options.py [PAGE]

Whatever stands between the two marks of the page is replaced; a test holds the page to what this writes.
"""

import sys
from collections.abc import Callable
from inspect import Parameter, signature
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

from typer.models import OptionInfo

from cadpanel.cli.examples import EXAMPLES
from cadpanel.cli.fit import fit
from cadpanel.cli.freecad import install
from cadpanel.cli.groups import GROUPS
from cadpanel.cli.main import COMMANDS

PAGE = Path(__file__).parent / "reference.md"
BEGIN, END = "<!-- made by examples/options.py -->\n", "<!-- end of what is made -->\n"


def options(command: Callable[..., None]) -> dict[str, tuple[Parameter, Any]]:
    """The options of a command by their names on the command line, and what is said of each."""
    found = {}
    for parameter in signature(command, eval_str=True).parameters.values():
        said = get_args(parameter.annotation)[1] if get_args(parameter.annotation) else None
        if isinstance(said, OptionInfo):
            named = [name for name in (said.default, *(said.param_decls or ())) if str(name).startswith("--")]
            found[str(named[0]) if named else f"--{parameter.name}"] = parameter, said
    return found


def value(parameter: Parameter, said: Any) -> str:
    """What stands for an option's value; nothing for one that has none."""
    kinds = [get_args(parameter.annotation)[0]]
    kinds += get_args(kinds[0])
    words = [word for kind in kinds if get_origin(kind) is Literal for word in get_args(kind)]
    return said.metavar or "|".join(words) or ("" if bool in kinds else "N")


def default(parameter: Parameter) -> str:
    """What holds where an option is not given; nothing where its meaning says it."""
    usual = parameter.default
    if isinstance(usual, bool) or not isinstance(usual, int | float | str):
        return ""
    return f"{usual:g}" if isinstance(usual, float) else str(usual)


def table(asked: dict[str, tuple[Parameter, Any]]) -> list[str]:
    """One row an option: how it is typed, what it means, and what holds where it is not given."""
    rows = []
    for name, (parameter, said) in asked.items():
        shown = default(parameter)
        typed = f"{name} {value(parameter, said)}".rstrip()
        row = (f"`{typed}`", " ".join(said.help.split()), shown)
        rows.append(f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in row)} |".replace("|  |", "| |"))
    return ["| option | meaning | default |", "|---|---|---|", *rows]


def of_fit() -> list[str]:
    """The options of `fit`, a table a group."""
    lines: list[str] = []
    asked = options(fit)
    for group in GROUPS:
        chosen = {name: one for name, one in asked.items() if one[1].rich_help_panel == group}
        lines += [f"{group}:", "", *table(chosen), ""]
    return lines


def of_another(command: Callable[..., None]) -> list[str]:
    """The options that another command has beside those of `fit`, and which of those it has."""
    usual, asked = options(fit), options(command)
    shared = [f"`{name}`" for name in asked if name in usual]
    left = [f"`{name}`" for name in usual if name not in asked]
    lines = [f"Of the options of `fit`: {', '.join(shared)}.", ""] if shared else []
    if len(shared) > len(left):
        lines = [f"The options of `fit` without {', '.join(left)}.", ""]
    other = {name: default(one) for name, (one, _) in asked.items() if name in usual}
    other = {name: one for name, one in other.items() if one != default(usual[name][0])}
    if told := [f"`{name} {one}`" for name, one in other.items() if one]:
        lines += [f"By default {', '.join(told)}.", ""]
    own = {name: one for name, one in asked.items() if name not in usual}
    return lines + ([*table(own), ""] if own else [])


def made() -> str:
    """What stands between the marks."""
    lines: list[str] = []
    for command in (*COMMANDS, install):
        name = command.__name__
        lines += [f"### cadpanel {'freecad ' if command is install else ''}{name}", ""]
        lines += [*(f"    {line}" for line in EXAMPLES[name]), ""]
        lines += of_fit() if command is fit else of_another(command)
    return "\n".join(lines)


def with_options(page: str) -> str:
    """The page with what the commands say between its marks."""
    before, _, rest = page.partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}\n{made()}\n{END}{after}"


if __name__ == "__main__":
    page = Path(sys.argv[1]) if len(sys.argv) > 1 else PAGE
    page.write_text(with_options(page.read_text(encoding="utf-8")), encoding="utf-8")
    print(f"Written: {page}")
