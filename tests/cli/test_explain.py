"""`cadpanel explain` says every word that tables, options and reports have, in whatever spelling."""

import pytest

from cadpanel.cli.explain import meant
from cadpanel.cli.glossary import GLOSSARY
from cadpanel.cli.tables import headings
from cadpanel.terms.limits.catalogue import LIMITS


def test_a_word_is_explained_with_its_drawing(run):
    answer = run("explain", "Step")
    assert answer.code == 0
    assert answer.out.startswith("step: The part of a gap along the skins' normal")
    assert "<--- width -->" in answer.out


@pytest.mark.parametrize(
    ("words", "name"),
    [(("side", "0"), "side"), (("--seam-turn",), "turn"), (("two_stage",), "two-stage"), (("U",), "U and V")],
)
def test_words_are_found_as_they_are_met(run, words, name):
    assert run("explain", "--", *words).out.startswith(f"{name}: ")


def test_without_a_word_all_are_listed(run):
    assert run("explain").out.splitlines() == [entry.name for entry in GLOSSARY]


def test_an_unknown_word_is_refused_with_those_like_it(run):
    answer = run("explain", "stepp")
    assert answer.code == 2
    assert answer.is_one_sentence()
    assert "perhaps 'step'" in answer.err


def test_every_entry_has_a_name_of_its_own_and_fits_a_terminal():
    names = [name.casefold() for entry in GLOSSARY for name in (entry.name, *entry.also)]
    assert len(set(names)) == len(names)
    assert all(len(line) <= 80 for entry in GLOSSARY for line in entry.drawing.splitlines())


def test_every_row_of_the_closing_table_is_explained_as_it_stands_there():
    unsaid = {"  of the panel's length"}
    assert [heading for heading in headings() if heading not in unsaid and not meant(heading).meaning] == []
    assert meant("Largest turn of a seam").name == "turn"


def test_every_option_is_explained_and_what_is_nearly_one_names_it(run):
    for option in ("--max-kink", "--outputs", "--mesh-chord", "--png"):
        assert run("explain", "--", option).out.startswith(f"{option}: ")
    assert "perhaps '--stock'" in run("explain", "--", "--stok").err


def test_the_limits_are_explained_by_their_names():
    for limit in LIMITS:
        if limit.name in ("seam_turn", "evenness", "seam_level", "max_kink", "drift_along", "drift_across"):
            assert meant(limit.name.removeprefix("max_")).meaning
