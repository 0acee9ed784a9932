"""Drawings on paper, read back by another library: as many pages as there should be, each with its panel's words."""

from __future__ import annotations

from pathlib import Path

from pypdf import PdfReader
from pypdf.errors import PyPdfError

from cadpanel.delivery.contents import Contents, Proof
from cadpanel.delivery.pages.fonts import shown
from cadpanel.delivery.pages.tables import bend_rows, fixing_rows
from cadpanel.errors import DeliveryError


def page_texts(path: Path) -> list[str]:
    """The words on every page, without the spaces between them.

    Raises:
        DeliveryError: the file cannot be read, or is none.
    """
    try:
        with path.open("rb") as file:
            return ["".join(page.extract_text().split()) for page in PdfReader(file, strict=True).pages]
    except OSError as error:
        raise DeliveryError(f"'{path}' cannot be read: {error.strerror or error}.") from error
    except (PyPdfError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise DeliveryError(f"'{path}' cannot be read: it is no whole PDF file ({error}).") from error


def prove_pages(path: Path, contents: Contents) -> Proof:
    """One sentence for everything that does not hold: pages, names, blanks, bends, lengths of edges."""
    texts = page_texts(path)
    wanted = len(contents.records) + 1
    if len(texts) != wanted:
        return Proof(failures=(f"'{path.name}' has {len(texts)} pages instead of {wanted}.",))
    names = [panel.name for panel in contents.records]
    failures = [
        f"'{path.name}' does not name panel '{name}' on its first page."
        for name in names
        if _plain(name) not in texts[0]
    ]
    for text, panel, part in zip(texts[1:], contents.records, contents.parts, strict=True):
        numbers = [f"{part.blank.width:.1f} x {part.blank.height:.1f} mm"]
        numbers += [f"{length:.1f}" for length in part.size.edges.values()]
        numbers += ["".join(row) for row in bend_rows(part.bends)]
        numbers += ["".join(row) for row in fixing_rows(part)]
        missing = [words for words in (panel.name, *numbers) if _plain(words) not in text]
        if missing:
            failures.append(f"'{path.name}': the page of panel '{panel.name}' does not say '{missing[0]}'.")
    return Proof(numbers={"pages": len(texts)}, failures=tuple(failures))


def _plain(words: str) -> str:
    return "".join(shown(words).split())
