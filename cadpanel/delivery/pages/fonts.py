"""Which font shows which sign: DejaVu for alphabets, fonts that readers have for East Asian signs, codes for others.

DejaVu is put into the file. The East Asian fonts are only named in it, by Adobe's character collections: readers show
their own fonts for them, and boxes, not other signs, where they have none.
"""

from __future__ import annotations

import unicodedata
from functools import cache
from itertools import groupby
from pathlib import Path

import matplotlib
from reportlab.pdfbase.cidfonts import UnicodeCIDFont
from reportlab.pdfbase.pdfmetrics import registerFont, stringWidth
from reportlab.pdfbase.ttfonts import TTFont

REGULAR, BOLD = "DejaVuSans", "DejaVuSans-Bold"
EAST_ASIAN = (("STSong-Light", "gbk"), ("HeiseiKakuGo-W5", "shift_jis"), ("HYGothic-Medium", "cp949"))
"""Fonts, and the encoding that has the signs of the collection each is of; the first that has a sign shows it."""
_TURNED = frozenset({"R", "AL", "AN"})
"""Directions of signs that are written from the right, and would come out in the wrong order and unjoined."""


@cache
def load_fonts() -> frozenset[int]:
    """Make the fonts known to the library; the signs that both alphabetic ones have."""
    folder = Path(matplotlib.get_data_path()) / "fonts" / "ttf"
    fonts = [TTFont(name, str(folder / f"{name}.ttf")) for name in (REGULAR, BOLD)]
    for font in (*fonts, *(UnicodeCIDFont(name) for name, _ in EAST_ASIAN)):
        registerFont(font)
    return frozenset(fonts[0].face.charToGlyph) & frozenset(fonts[1].face.charToGlyph)


def shown(words: str) -> str:
    """Words as they are printed: signs that no font shows as they are to be read stand as their codes, <U+1F3E0>."""
    return "".join(
        sign if _font_of(sign) is not None else f"<U+{ord(sign):04X}>" for sign in unicodedata.normalize("NFC", words)
    )


def runs(words: str, *, bold: bool = False) -> list[tuple[str, str]]:
    """Words as they are printed, font by font: its name, and what it shows."""
    return [
        (BOLD if bold and font == REGULAR else font, "".join(signs))
        for font, signs in groupby(shown(words), lambda sign: _font_of(sign) or REGULAR)
    ]


def width_in_points(words: str, size: float, *, bold: bool = False) -> float:
    """How long words are in letters of a size; both in a printer's points."""
    return float(sum(stringWidth(text, font, size) for font, text in runs(words, bold=bold)))


@cache
def _font_of(sign: str) -> str | None:
    """The font that shows a sign; None where it would come out wrong, or not at all."""
    if not sign.isprintable() or unicodedata.bidirectional(sign) in _TURNED or unicodedata.category(sign)[0] == "M":
        return None
    if ord(sign) in load_fonts():
        return REGULAR
    return next((font for font, encoding in EAST_ASIAN if _encodes(encoding, sign)), None)


def _encodes(encoding: str, sign: str) -> bool:
    try:
        sign.encode(encoding)
    except UnicodeEncodeError:
        return False
    return True
