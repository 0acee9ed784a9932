"""Numbers as other programs write them: all that ISO 10303-21 (6.4.2) and IGES 5.3 (2.2.2) allow is read alike."""

import re

import numpy as np
import pytest

from cadpanel.brep.faces.face_patch import patch_of
from cadpanel.brep.files.loading import load_model
from cadpanel.brep.files.model import Label
from tests.model_files import Labelled, strip_faces, write_labelled
from tests.reference_shapes import Lip

REAL = re.compile(r"(?<=[(,\s=])-?\d+\.\d*(?:E[+-]?\d+)?(?=[,);\s])")
PARTS = np.linspace(0.0, 1.0, 5)


def power(number, digits, letter="E"):
    mantissa, exponent = f"{number:.16e}".split("e")
    return f"{mantissa}{letter}{int(exponent):+0{digits + 1}d}"


STEP_FORMS = {
    "three digits": lambda x: power(x, 3),
    "many digits": lambda x: power(x, 7),
    "nothing behind the point": lambda x: "0.E+000" if x == 0.0 else power(x, 3),
    "no sign": lambda x: power(x, 3).replace("+", ""),
    "plus": lambda x: f"{x:+.16E}",
    "zero of any power": lambda x: "0.E+400" if x == 0.0 else power(x, 2),
    "less than any": lambda x: "1.E-400" if x == 0.0 else power(x, 2),
    "blanks": lambda x: f"\n {x:.16E} ",
    "no power": lambda x: f"{x:.40f}",
    "leading zeros": lambda x: f"{'-' if x < 0.0 else ''}000{abs(x):.40f}",
}
IGES_FORMS = {
    "three digits": lambda x: power(x, 3),
    "double": lambda x: power(x, 2, "D"),
    "double, three digits": lambda x: power(x, 3, "D"),
    "plus": lambda x: f"{x:+.16E}",
    "blanks": lambda x: f"  {x:.16E}",
    "no power": lambda x: f"{x:.30f}",
}


@pytest.fixture(scope="module")
def originals(tmp_path_factory):
    folder = tmp_path_factory.mktemp("numbers")
    parts: list[Labelled] = [(Label(name=f"face {k}"), face, []) for k, face in enumerate(strip_faces(Lip(), poles=5))]
    return {ending: write_labelled(folder / f"strip.{ending}", parts).read_text() for ending in ("step", "iges")}


def points_of(path, text):
    path.write_text(text)
    patches = [patch_of(face.face) for face in load_model(path).faces()]
    assert len(patches) == 3
    return np.concatenate([patch.points(patch.at(0, PARTS[:, None], PARTS)) for patch in patches])


def flowed(text, form):
    """An IGES file with the reals of its parameter section written another way, its lines and pointers laid anew."""
    lines = text.splitlines()
    section = {letter: [line for line in lines if line[72] == letter] for letter in "SGDPT"}
    written: list[str] = []
    starts: dict[int, tuple[int, int]] = {}
    entities: dict[int, list[str]] = {}
    for line in section["P"]:
        entities.setdefault(int(line[64:72]), []).append(line[:64].rstrip())
    for entry, own in entities.items():
        words = re.split(r"(?<=[,;])", REAL.sub(lambda found: form(float(found.group())), "".join(own)))
        rows = [""]
        for word in words:
            if len(rows[-1]) + len(word) > 64:
                rows.append("")
            rows[-1] += word
        starts[entry] = (len(written) + 1, len(rows))
        written += [f"{row:<64}{entry:>8}P{len(written) + place:>7}" for place, row in enumerate(rows, start=1)]
    directory = list(section["D"])
    for entry, (start, count) in starts.items():
        first, second = directory[entry - 1], directory[entry]
        directory[entry - 1] = first[:8] + f"{start:>8}" + first[16:]
        directory[entry] = second[:24] + f"{count:>8}" + second[32:]
    end = f"{section['T'][0][:24]}P{len(written):>7}".ljust(72) + "T      1"
    return "\n".join([*section["S"], *section["G"], *directory, *written, end, ""])


@pytest.mark.parametrize("form", STEP_FORMS)
def test_step_reads_every_legal_form_of_a_number_the_same(originals, tmp_path, form):
    head, data = originals["step"].split("DATA;", 1)
    changed = f"{head}DATA;{REAL.sub(lambda found: STEP_FORMS[form](float(found.group())), data)}"
    assert changed != originals["step"]
    wanted = points_of(tmp_path / "plain.step", originals["step"])
    np.testing.assert_allclose(points_of(tmp_path / "other.step", changed), wanted, atol=1e-9)


@pytest.mark.parametrize("form", IGES_FORMS)
def test_iges_reads_every_legal_form_of_a_number_the_same(originals, tmp_path, form):
    changed = flowed(originals["iges"], IGES_FORMS[form])
    wanted = points_of(tmp_path / "plain.iges", originals["iges"])
    np.testing.assert_allclose(points_of(tmp_path / "other.iges", changed), wanted, atol=1e-9)
