"""The proof of a delivery: its files are read back and held against its report, now or at any later time."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from cadpanel.brep.proof.parallel import Helper
from cadpanel.brep.proof.rebuilt import Rebuilt
from cadpanel.brep.read import read_reference
from cadpanel.delivery.chosen_panels import chosen_panels
from cadpanel.delivery.contents import Contents, Proof
from cadpanel.delivery.manifest import MANIFEST, changed_files, unlisted_files
from cadpanel.delivery.outputs.catalogue import OUTPUTS, chosen_outputs
from cadpanel.delivery.outputs.output import Output
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.parts_done import PartsDone
from cadpanel.delivery.records.certified import CertificateModel
from cadpanel.delivery.records.consistency import check_report
from cadpanel.delivery.records.flat_parts import flat_parts
from cadpanel.delivery.records.measured_again import measured_faults, reading_again
from cadpanel.delivery.records.part_checks import part_faults
from cadpanel.delivery.records.report import ReportModel, read_report
from cadpanel.delivery.records.to_shape import Built, recorded_shapes
from cadpanel.delivery.return_checks import return_faults
from cadpanel.delivery.sheets import Progress, say_nothing
from cadpanel.delivery.step_proof import Proved, prove_steps
from cadpanel.delivery.unproved import BY_A_FIT, BY_REFERENCE, IN_NO_FILE, words
from cadpanel.errors import DeliveryError, SettingsError
from cadpanel.kinds import checked
from cadpanel.sizes import refuse_huge


@dataclass(frozen=True, slots=True, kw_only=True)
class Verification:
    """What a delivery folder shows.

    Attributes:
        report: its report, as it was read.
        certificate: what its STEP files show now.
        failures: one sentence for everything that does not hold, naming the panel or the seam.
        unproved: what the report says that was not proved, in the words of its keys.
    """

    report: ReportModel
    certificate: CertificateModel
    failures: tuple[str, ...]
    unproved: tuple[str, ...]

    def __repr__(self) -> str:
        found = "everything holds" if self.holds else f"{len(self.failures)} failures, first {self.failures[0]:.80}"
        return f"<Verification of {len(self.report.panels)} panels: {found}>"

    @property
    def holds(self) -> bool:
        """Whether the files are what the report promises."""
        return not self.failures


@checked
def verify(
    folder: str | Path, reference: str | Path | None = None, *, progress: Progress | None = None
) -> Verification:
    """Read a delivery's files and hold them against its report, and the report against itself.

    Args:
        folder: that `deliver` wrote.
        reference: the file that the panels approximate, to measure deviation, drift and turn of seams again; without
            it they are listed as not proved.
        progress: told the step, "verify", and how much of it is done of how much.

    Raises:
        DeliveryError: the folder or one of its files is missing or cannot be read; one sentence says which.
        ReferenceFileError: the reference cannot be read as the report says that it was.
    """
    place = Path(folder)
    if not place.is_dir():
        raise DeliveryError(f"'{folder}' is not a folder: name one that 'cadpanel fit' wrote.")
    _demand_files(place, (REPORT, MANIFEST))
    report = read_report(place / REPORT)
    try:
        outputs, shapes = chosen_outputs(report.settings.outputs, OUTPUTS), recorded_shapes(report)
        contents = contents_of(report, shapes)
    except SettingsError as error:
        raise DeliveryError(f"'{place / REPORT}' holds a setting that is none ({error}): write it again.") from error
    _demand_files(place, [file for output in outputs for file in (*output.files, *output.folders)])
    certificate = prove(place, contents, outputs, progress=progress).certificate
    failures = (
        *_changed(place),
        *_unlisted(place, outputs),
        *certificate.failures,
        *check_report(report, shapes, certificate),
    )
    if reference is None:
        return Verification(
            report=report,
            certificate=certificate,
            failures=failures,
            unproved=words(BY_REFERENCE, BY_A_FIT, IN_NO_FILE),
        )
    file = Path(reference)
    again = measured_faults(report, read_reference(file, reading_again(report.reference, file)))
    listed = words(BY_A_FIT, IN_NO_FILE)
    return Verification(report=report, certificate=certificate, failures=(*failures, *again), unproved=listed)


def _changed(place: Path) -> Iterator[str]:
    for name in changed_files(place):
        yield f"'{name}' is not the file that was delivered: its size or SHA-256 is not that in {MANIFEST}."


def _unlisted(place: Path, outputs: Sequence[Output]) -> Iterator[str]:
    """What is said of files of the delivery that its manifest leaves out; others may have put theirs beside them."""
    own = {REPORT, *(name for output in outputs for name in (*output.files, *output.folders))}
    for name in unlisted_files(place):
        if name.split("/", maxsplit=1)[0] in own:
            yield f"{MANIFEST} does not tell of '{name}', which belongs to the delivery."


def _demand_files(place: Path, names: Sequence[str]) -> None:
    for name in names:
        if not (place / name).exists():
            raise DeliveryError(f"'{place}' holds no {name}, so it is no whole delivery: write it again.")
        for file in (place / name, *(place / name).glob("*")):
            refuse_huge(file, DeliveryError)


def contents_of(report: ReportModel, shapes: Sequence[Built]) -> Contents:
    """What the files must tell of, from the report's own numbers."""
    sheet, shop = report.settings.sheet(), report.settings.shop()
    chosen = set(chosen_panels([panel.name for panel in report.panels], shop.only))
    parts = flat_parts(shapes, sheet, shop)
    own = [place for place, panel in enumerate(report.panels) if panel.name in chosen]
    return Contents(
        title=Path(report.reference.file).stem,
        sheet=sheet,
        shop=shop,
        records=tuple(report.panels[place] for place in own),
        seams=report.seams,
        shapes=tuple(shapes[place] for place in own),
        parts=tuple(parts[place] for place in own),
        joint=report.settings.joint,
        origin=report.origin.offset,
        summary=report.summary,
    )


def prove(
    folder: Path,
    contents: Contents,
    outputs: Sequence[Output],
    helper: Helper | None = None,
    built: Mapping[str, Rebuilt] | None = None,
    progress: Progress | None = None,
) -> Proved:
    """What reading the files in a folder back shows.

    Args:
        folder: that holds the files.
        contents: what they must tell of.
        outputs: those that were written.
        helper: a second interpreter that is running already.
        built: by name, what bounds panels that were built from the same numbers already; others are built anew.
        progress: told how much is done.

    Raises:
        DeliveryError: one of the files cannot be read at all.
    """
    count = len(contents.records)
    others = [output for output in outputs if not output.always]
    # Of every panel the solid and the skin, the sheet that is built anew, and what each other output says of it.
    done = PartsDone(progress or say_nothing, "verify", (3 + len(others)) * count - len(built or ()))
    found: dict[str, Proof] = {}
    for output in others:
        found |= _prove_each(folder, contents, (output,))
        done(count)
    proved = prove_steps(folder, contents, helper, built, done)
    failures = (
        *proved.certificate.failures,
        *part_faults(contents.records, contents.parts, contents.shop.density),
        *return_faults(contents),
    )
    certificate = proved.certificate.model_copy(update={"failures": failures})
    return replace(proved, certificate=_with_outputs(certificate, found))


def prove_more(proved: Proved, folder: Path, contents: Contents, outputs: Sequence[Output]) -> Proved:
    """The same with what further outputs show, which were written when joints had been measured.

    Raises:
        DeliveryError: one of the files cannot be read at all.
    """
    return replace(proved, certificate=_with_outputs(proved.certificate, _prove_each(folder, contents, outputs)))


def _prove_each(folder: Path, contents: Contents, outputs: Sequence[Output]) -> dict[str, Proof]:
    return {output.name: output.prove(folder, contents) for output in outputs if not output.always}


def _with_outputs(certificate: CertificateModel, found: dict[str, Proof]) -> CertificateModel:
    """A certificate with what outputs show."""
    numbers = {name: proof.numbers for name, proof in found.items()}
    faults = [fault for proof in found.values() for fault in proof.failures]
    return certificate.model_copy(
        update={
            "outputs": {**certificate.outputs, **numbers},
            "failures": (*certificate.failures, *faults),
        }
    )
