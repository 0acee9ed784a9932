"""`cadpanel view` opens the page of a delivery, or draws it; what it cannot open it says in one sentence."""

from __future__ import annotations

import pytest

from tests.pages import write_page


def test_it_opens_the_page_in_a_browser(run, tmp_path, monkeypatch):
    opened: list[str] = []

    def open_it(address):
        opened.append(address)
        return True

    monkeypatch.setattr("webbrowser.open", open_it)
    page = write_page(tmp_path)
    assert run("view", tmp_path).code == 0
    assert opened == [page.resolve().as_uri()]


def test_without_a_browser_it_says_what_else_to_do(run, tmp_path, monkeypatch):
    monkeypatch.setattr("webbrowser.open", lambda _: False)
    write_page(tmp_path)
    answer = run("view", tmp_path)
    assert answer.code == 2
    assert answer.is_one_sentence()
    assert "--png FILE" in answer.err


def test_it_draws_without_a_screen(run, tmp_path):
    write_page(tmp_path)
    picture = tmp_path / "step.png"
    answer = run("view", tmp_path, "--png", picture, "--color", "step", "--from", "north")
    assert (answer.code, answer.out, answer.err) == (0, "", "")
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_the_page_itself_may_be_named_and_what_only_pictures_have_is_refused(run, tmp_path, monkeypatch):
    monkeypatch.setattr("webbrowser.open", lambda _: True)
    page = write_page(tmp_path)
    assert run("view", page).code == 0
    for words, said in ((("--color", "gap"), "go with --png"), (("--png", tmp_path / "a.jpg"), "let it end in .png")):
        answer = run("view", page, *words)
        assert (answer.code, answer.is_one_sentence()) == (2, True)
        assert said in answer.err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--png", "a.png"), "holds no report.html: name a folder that 'cadpanel fit' wrote, with html among"),
        (("--color", "red"), "'red' is not one of"),
    ],
)
def test_refusals_are_one_sentence(run, tmp_path, words, said):
    answer = run("view", tmp_path, *words)
    assert answer.code == 2
    assert answer.is_one_sentence()
    assert said in answer.err
