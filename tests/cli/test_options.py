"""Options are made of the fields of settings: where they stand, what they show, and what is left to the settings."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import pytest
import typer

from cadpanel.cli import main as program
from cadpanel.cli import options
from cadpanel.errors import SettingsError
from cadpanel.setting import Option, Range, check_ranges, setting


def halved(option: str, text: str) -> float:
    if not text.isdecimal():
        raise SettingsError(f"{option} takes digits, not '{text}'")
    return float(text) / 2.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Oven:
    heat: float = setting(
        200.0, within=Range(what="heat", least=50.0, most=300.0, unit=" C"), option=Option(metavar="C", help="Degrees.")
    )
    half_time: float | None = setting(
        0.1, option=Option(takes=str, read=halved, show=lambda _: "0.3", metavar="MIN", help="Of the whole.")
    )
    fan: bool = setting(False, option=Option(help="With the fan?"))
    dishes: tuple[str, ...] = setting((), option=Option(takes=list[str], told=False, help="What goes in."))

    def __post_init__(self) -> None:
        check_ranges(self)


@pytest.fixture
def bake(monkeypatch: pytest.MonkeyPatch) -> Callable[..., list[object]]:
    """Run a command that takes an oven's settings; what it was called with."""
    called: list[object] = []

    @options.made_of_settings
    def work(food: str, oven: Oven, quiet: options.Quiet = False) -> None:
        """Bake."""
        called.extend((food, oven, quiet))

    @options.made_of_settings
    def warm(oven: Annotated[Oven, options.Only(("fan", "heat"))]) -> None:
        """Keep warm."""
        called.append(oven)

    @options.made_of_settings
    def try_out(
        oven: Annotated[tuple[Oven, ...], options.Each({"heat": "--heats", "half_time": "--half-time"})],
    ) -> None:
        """Try several."""
        called.append(oven)

    @options.made_of_settings
    def grill(oven: Annotated[Oven, options.Without(("fan", "half_time"))]) -> None:
        """Grill."""
        called.append(oven)

    app = typer.Typer(pretty_exceptions_enable=False)
    app.callback()(lambda: None)
    for command in (work, warm, try_out, grill):
        app.command()(command)
    monkeypatch.setattr(program, "app", app)

    def run(*words: str, code: int = 0) -> list[object]:
        assert program.main(words) == code
        return called

    return run


Bake = Callable[..., list[object]]


def test_what_is_not_given_is_left_to_the_settings(bake: Bake) -> None:
    assert bake("work", "bread") == ["bread", Oven(), False]


def test_what_is_given_arrives_as_the_setting_has_it(bake: Bake) -> None:
    words = "work bread --half-time 50 --heat 250 --fan --dishes one --dishes two --quiet"
    (_, oven, quiet) = bake(*words.split())
    assert quiet is True
    assert isinstance(oven, Oven)
    assert (oven.heat, oven.half_time, oven.fan, tuple(oven.dishes)) == (250.0, 25.0, True, ("one", "two"))


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--heat 20", "The heat must be between 50 C and 300 C, not 20 C.\n"),
        ("--half-time soon", "--half-time takes digits, not 'soon'.\n"),
        ("--heat hot", "Invalid value for '--heat': "),
    ],
)
def test_what_will_not_do_is_one_sentence(
    bake: Bake, capsys: pytest.CaptureFixture[str], words: str, said: str
) -> None:
    bake("work", "bread", *words.split(), code=2)
    answer = capsys.readouterr()
    assert answer.err.startswith(said)
    assert answer.out == ""
    assert answer.err.count("\n") == 1


def test_options_stand_where_the_settings_stand_and_show_their_defaults(
    bake: Bake, capsys: pytest.CaptureFixture[str]
) -> None:
    bake("work", "--help")
    shown = capsys.readouterr().out
    places = [shown.index(word) for word in ("--heat", "--half-time", "--fan", "--dishes", "--quiet")]
    assert places == sorted(places)
    assert "[default: 200.0]" in shown
    assert "[default: 0.3]" in shown  # whatever an option makes of what it shows, the setting's own default counts
    assert "--no-fan" not in shown


def test_a_command_may_ask_for_some_settings_only_and_in_its_own_order(
    bake: Bake, capsys: pytest.CaptureFixture[str]
) -> None:
    bake("warm", "--help")
    shown = capsys.readouterr().out
    assert shown.index("--fan") < shown.index("--heat")
    assert "--half-time" not in shown
    bake("grill", "--help")
    shown = capsys.readouterr().out
    assert "--heat" in shown
    assert "--fan" not in shown
    assert bake("warm", "--heat", "60") == [Oven(heat=60.0)]


def test_a_list_of_values_makes_settings_for_every_combination_without_doubles(bake: Bake) -> None:
    (ovens,) = bake("try-out", "--heats", "60, 70,60", "--half-time", "4,8", "--fan")
    assert isinstance(ovens, tuple)
    assert [(oven.heat, oven.half_time, oven.fan) for oven in ovens] == [
        (60.0, 2.0, True),
        (60.0, 4.0, True),
        (70.0, 2.0, True),
        (70.0, 4.0, True),
    ]
    assert bake("try-out")[-1] == (Oven(),)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--heats 60,hot", "--heats is a list of numbers like 1,2,5, not 'hot'.\n"),
        ("--heats 60,20", "The heat must be between 50 C and 300 C, not 20 C.\n"),
        ("--half-time 4,soon", "--half-time takes digits, not 'soon'.\n"),
    ],
)
def test_one_wrong_value_of_a_list_is_one_sentence(
    bake: Bake, capsys: pytest.CaptureFixture[str], words: str, said: str
) -> None:
    bake("try-out", *words.split(), code=2)
    assert capsys.readouterr().err == said


def test_help_and_refusals_wait_neither_for_the_kernel_nor_for_scipy() -> None:
    code = (
        "import sys; from cadpanel.cli.main import main; "
        "assert main(['fit', 'no such file.step', '--out', '.']) == 2; "
        "assert main(['compare', '--help']) == 0; "
        "print(sorted({'OCP', 'scipy'} & set(sys.modules)))"
    )
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert answer.returncode == 0, answer.stderr
    assert answer.stdout.splitlines()[-1] == "[]"


NONE, BESIDE, OUT = ("none.step",), ("there.step", "--network", "none.step"), ("--out", "out")


def test_a_file_that_is_not_there_is_told_before_the_kernel_is_loaded(tmp_path: Path) -> None:
    every = (("fit", *NONE, *OUT), ("compare", *NONE, *OUT), ("inspect", *NONE), ("fit", *BESIDE, *OUT))
    (tmp_path / "there.step").write_text("ISO-10303-21;")
    code = (
        f"import sys; from cadpanel.cli.main import main; codes = [main([*words]) for words in {every!r}]; "
        "print(codes, sorted({'OCP', 'scipy'} & set(sys.modules)))"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=tmp_path, check=True)
    assert found.stdout == "[2, 2, 2, 2] []\n"
    assert found.stderr == len(every) * "'none.step' does not exist: check the name and the folder.\n"
