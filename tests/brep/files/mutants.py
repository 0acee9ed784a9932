"""Mutants of STEP and Rhino files that keep their form: what a writer at fault, or another writer, would leave.

`python -m tests.brep.files.mutants 250` reads so many of each kind and says what became of them.
"""

from __future__ import annotations

import random
import re
import struct
import sys
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

from cadpanel.brep.files.model import Label
from cadpanel.brep.survey import survey
from cadpanel.errors import CadpanelError
from tests.model_files import strip_faces, write_labelled
from tests.reference_shapes import Lip
from tests.rhino_breps import Tube
from tests.rhino_files import bent_surface, file_in, rhino, written

INSTANCE = re.compile(r"#(\d+)\s*=\s*([A-Z_0-9]*)\s*\((.*?)\)\s*;", re.DOTALL)
REFERENCE = re.compile(r"#\d+")
REAL = re.compile(r"(?<=[(,])-?\d+\.\d*(?:E[+-]?\d+)?(?=[,)])")
NEUTRAL = 4
"""The first so many kinds of STEP mutants mean what the file meant."""
Mutation = Callable[[list[str], random.Random], list[str]]
# Where the numbers of a trim stand in openNURBS' form: index, curve, edge, vertices, direction, kind, side and loop.
TRIM_INTEGERS = (0, 4, 24, 28, 32, 36, 40, 44, 48)
TRIM_DOUBLES = (8, 16, 52, 60, 68, 76)
TRIM_BYTES = 132


def originals(folder: Path) -> dict[str, bytes]:
    """A STEP file of three faces, and a Rhino file of a whole face and one with a seam."""
    faces = strip_faces(Lip(), poles=6)
    step = write_labelled(folder / "strip.step", [(Label(name=f"face {k}"), face, []) for k, face in enumerate(faces)])
    file = file_in()
    file.Objects.AddBrep(Tube().brep())
    file.Objects.AddBrep(rhino.Brep.CreateFromSurface(bent_surface()))
    return {"strip.step": step.read_bytes(), "tube.3dm": written(folder / "tube.3dm", file).read_bytes()}


def _instances(text: str) -> tuple[str, list[str], str]:
    head, data = text.split("DATA;", 1)
    body, tail = data.split("ENDSEC;", 1)
    return f"{head}DATA;\n", [found.group(0) for found in INSTANCE.finditer(body)], f"\nENDSEC;{tail}"


def step_mutant(data: bytes, seed: int) -> tuple[bytes, bool]:
    """One mutant of a STEP file, always the same for a seed; and whether it means the same."""
    chance = random.Random(seed)
    head, instances, tail = _instances(data.decode())
    kind = seed % len(STEP_KINDS)
    return (head + "\n".join(STEP_KINDS[kind](instances, chance)) + tail).encode(), kind < NEUTRAL


def _shuffled(instances: list[str], chance: random.Random) -> list[str]:
    return chance.sample(instances, len(instances))


def _renumbered(instances: list[str], chance: random.Random) -> list[str]:
    by = chance.randrange(7, 90_000)
    return [REFERENCE.sub(lambda found: f"#{int(found.group()[1:]) + by}", one) for one in instances]


def _commented(instances: list[str], chance: random.Random) -> list[str]:
    parted = [one if "'" in one else one.replace(",", " ,\n ", 1) for one in instances]
    return [f"/* {chance.random()} */ {one}" for one in parted]


def _spelled(instances: list[str], _chance: random.Random) -> list[str]:
    def spell(found: re.Match[str]) -> str:
        mantissa, exponent = f"{float(found.group()):.16E}".split("E")
        return f"{mantissa}E{int(exponent):+04d}"

    return [REAL.sub(spell, one) for one in instances]


def _without(instances: list[str], chance: random.Random) -> list[str]:
    gone = chance.randrange(len(instances))
    return instances[:gone] + instances[gone + 1 :]


def _twice(instances: list[str], chance: random.Random) -> list[str]:
    one, other = chance.sample(instances, 2)
    number = other.split("=", 1)[0]
    return [*instances, f"{number}={one.split('=', 1)[1]}"]


def _one_changed(change: Callable[[str, random.Random, list[str]], str]) -> Mutation:
    def changed(instances: list[str], chance: random.Random) -> list[str]:
        found = list(instances)
        for place in chance.sample(range(len(found)), len(found)):
            new = change(found[place], chance, instances)
            if new != found[place]:
                found[place] = new
                break
        return found

    return changed


def _other_reference(one: str, chance: random.Random, instances: list[str]) -> str:
    head, _, rest = one.partition("=")
    places = list(REFERENCE.finditer(rest))
    if not places:
        return one
    place, other = chance.choice(places), chance.choice(instances).split("=", 1)[0].strip()
    return f"{head}={rest[: place.start()]}{other}{rest[place.end() :]}"


def _other_number(one: str, chance: random.Random, _instances: list[str]) -> str:
    places = list(REAL.finditer(one))
    if not places:
        return one
    place = chance.choice(places)
    new = chance.choice(("0.", "-1.", "1.E+99", "1.E-300", "7.7", "-1.E7", place.group().lstrip("-")))
    return one[: place.start()] + new + one[place.end() :]


def _missing(one: str, chance: random.Random, _instances: list[str]) -> str:
    places = [*REAL.finditer(one), *REFERENCE.finditer(one, one.find("=") + 1)]
    if not places:
        return one
    place = chance.choice(places)
    return one[: place.start()] + chance.choice(("$", "*", "()", "'x'")) + one[place.end() :]


def _turned(one: str, _chance: random.Random, _instances: list[str]) -> str:
    return one.replace(".T.", ".F.", 1) if ".T." in one else one.replace(".F.", ".T.", 1)


STEP_KINDS = (
    *(_shuffled, _renumbered, _commented, _spelled),
    *(_without, _twice, *map(_one_changed, (_other_reference, _other_number, _missing, _turned))),
)


def rhino_mutant(_data: bytes, seed: int) -> tuple[bytes, bool]:
    """One mutant of a Rhino file with trims, always the same for a seed; its sums are right, and openNURBS takes it."""
    chance = random.Random(seed)

    def change(trims: bytes) -> bytes:
        text, trim = bytearray(trims), TRIM_BYTES * chance.randrange(4)
        if seed % 2:
            place = trim + chance.choice(TRIM_INTEGERS)
            text[place : place + 4] = struct.pack("<i", chance.choice((-1, 0, 1, 2, 3, 4, 5)))
        else:
            place = trim + chance.choice(TRIM_DOUBLES)
            text[place : place + 8] = struct.pack("<d", chance.choice((-1.0, 0.5, 2.0, 1e300, 0.0, 0.999)))
        return bytes(text)

    tube = Tube(apex=chance.random() < 0.5, round_v=chance.random() < 0.5)
    file = file_in()
    file.Objects.AddBrep(tube.brep(change=change))
    file.Objects.AddBrep(rhino.Brep.CreateFromSurface(bent_surface()))
    with TemporaryDirectory() as name:
        return written(Path(name) / "mutant.3dm", file).read_bytes(), False


MUTANTS = {"strip.step": step_mutant, "tube.3dm": rhino_mutant}


def read(path: Path) -> tuple[str, float]:
    """What becomes of a file: the sentence that refuses it, empty where it is read; and the area of its faces, mm^2."""
    try:
        found = survey(path)
    except CadpanelError as error:
        return str(error), 0.0
    return "", sum(face.area for face in found.faces)


def ending(said: str, area: float, wanted: float | None) -> str:
    """What became of a mutant, in a word; `wanted` is the area of one that means the same."""
    if "crash" in said or "keeps the CAD kernel busy" in said:
        return "crash or endless, told"
    if said:
        return "refused" if wanted is None and said.endswith(".") else "WRONG"
    return "read" if wanted is None or abs(area - wanted) <= 1e-9 * wanted else "WRONG"


def main(count: int) -> None:
    """Read so many mutants of each file, and print what became of them."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        for file, data in originals(folder).items():
            path, found, slowest = folder / file, Counter[str](), 0.0
            _, whole = read(path)
            began = time.perf_counter()
            read(path)
            to_read = time.perf_counter() - began
            for seed in range(count):
                text, same = MUTANTS[file](data, seed)
                path.write_bytes(text)
                began = time.perf_counter()
                said, area = read(path)
                seconds = time.perf_counter() - began
                end = ending(said, area, whole if same else None)
                found[end] += 1
                if end == "refused":
                    slowest = max(slowest, seconds)
                if end == "WRONG":
                    sys.stdout.write(f"{file} {seed}: {said or area}\n")
            sys.stdout.write(f"{file}: {dict(found)}; to read {to_read:.3f} s, slowest refusal {slowest:.3f} s\n")
            sys.stdout.flush()


if __name__ == "__main__":
    main(int(sys.argv[1]))
