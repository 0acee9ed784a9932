"""Damage to files, always the same for a seed: to bytes of any file, to lines of text, and to the values of JSON."""

from __future__ import annotations

import json
import random
import re
from typing import Any

NUMBERS = re.compile(rb"(?<=[\s(,])-?\d+\.?\d*(?=[\s,)])")
REFERENCES = re.compile(rb"#\d+")
CUT, FLIP, TYPE, DROP, NUMBER, SWAP = range(6)
KINDS = 6
STRANGE: tuple[Any, ...] = (
    *(None, True, False, 0, -1, 1e300, -1e300, 1e-300, 2**63, 10**400, 0.5, "", "x", "\x1b[31m\x07", "é" * 5000),
    *([], {}, [[]], [None], {"": {}}, [1e308] * 4),
)


def damaged(data: bytes, seed: int) -> bytes:
    """One of six kinds of damage, always the same for the same seed."""
    chance, text = random.Random(seed), bytearray(data)
    kind, times = seed % KINDS, chance.choice((1, 1, 3, 12))
    if kind == CUT:
        return bytes(text[: chance.randrange(1, len(text))])
    for _ in range(times):
        if not text:
            break
        if kind == FLIP:
            text[chance.randrange(len(text))] ^= 1 << chance.randrange(8)
        elif kind == TYPE:
            text[chance.randrange(len(text))] = chance.choice(b"0123456789.-E#,()$*'\n ")
        elif kind == DROP:
            start = chance.randrange(len(text))
            del text[start : start + chance.randrange(1, 200)]
        else:
            found = list((NUMBERS if kind == NUMBER else REFERENCES).finditer(bytes(text)))
            if not found:
                text[chance.randrange(len(text))] = 0
                continue
            place = chance.choice(found)
            other = chance.choice((b"0", b"-1", b"1e99", b"300", b"99999999", b"-0.", chance.choice(found).group()))
            text[place.start() : place.end()] = chance.choice(found).group() if kind == SWAP else other
    return bytes(text)


def lines_damaged(data: bytes, seed: int) -> bytes:
    """Lines left out, doubled, moved, or with a word changed for one from elsewhere in the file."""
    chance, lines = random.Random(seed), data.split(b"\n")
    for _ in range(chance.choice((1, 1, 2, 8))):
        at, other = chance.randrange(len(lines)), chance.randrange(len(lines))
        kind = seed % 4
        if kind == 0 and len(lines) > 1:
            del lines[at]
        elif kind == 1:
            lines.insert(at, lines[other])
        elif kind == 2:
            lines[at], lines[other] = lines[other], lines[at]
        else:
            words, others = lines[at].split(b" "), lines[other].split(b" ")
            words[chance.randrange(len(words))] = chance.choice((*others, b"-1", b"1e99", b"nan", b"0", b"999999999"))
            lines[at] = b" ".join(words)
    return b"\n".join(lines)


def json_damaged(data: bytes, seed: int) -> bytes:
    """A value changed for a strange one or for another value of the file, a key left out, a list cut or doubled."""
    chance, content = random.Random(seed), json.loads(data)
    for _ in range(chance.choice((1, 1, 2, 5))):
        places = list(_places(content))
        holder, key = chance.choice(places)
        kind = seed % 5
        if kind == 0:
            holder[key] = chance.choice(STRANGE)
        elif kind == 1:
            other, there = chance.choice(places)
            holder[key] = json.loads(json.dumps(other[there]))
        elif kind == 2:
            del holder[key]
        elif kind == 3 and isinstance(holder[key], int | float) and not isinstance(holder[key], bool):
            holder[key] = chance.choice((-holder[key], holder[key] * (1.0 + 1e-3), 0, holder[key] * 1e9, 1e-320))
        elif isinstance(holder[key], list):
            holder[key] = holder[key] * 2 if chance.random() < 0.5 else holder[key][:-1]
        else:
            holder[key] = [holder[key]]
        if not isinstance(content, dict) or not content:
            break
    return json.dumps(content).encode()


def _places(content: Any) -> Any:
    """Every place of a value: what holds it, and under which key."""
    keys = content.keys() if isinstance(content, dict) else range(len(content)) if isinstance(content, list) else ()
    for key in list(keys):
        yield content, key
        yield from _places(content[key])
