"""Results as a shop reads them: millimetres, degrees, percent."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table
from rich.text import Text

from cadpanel.cli.printable import PrintableConsole
from cadpanel.delivery.outputs.report_html import PAGE
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.records.certified import CertificateModel, TimingModel
from cadpanel.delivery.records.comparison import ComparisonModel
from cadpanel.delivery.records.report import ReportModel, SummaryModel
from cadpanel.delivery.records.settings import ComparisonSettingsModel
from cadpanel.delivery.records.to_shape import fitted_patches
from cadpanel.terms.limits.catalogue import LIMITS

# Deviation in mm that is worth a line of its own.
_WORTH_TELLING = 0.05
# Degrees between neighbours above which the break is seen.
_KINK_SEEN = 3.0
# Notes that are printed; all of them are in the report.
_MOST_NOTES = 5
DASH = "-"
# What a little more of each limit is, and how much of its unit.
_WORTH = {
    "gap": ("1 mm more gap", 1.0),
    "width": ("joints 1 mm wider or narrower", 1.0),
    "step": ("1 mm more step", 1.0),
    "shift": ("1 mm more shift", 1.0),
    "seam_turn": ("1 degree more turn of seams", 1.0),
    "seam_level": ("level seams 1 mm further off their planes", 1.0),
    "max_kink": ("1 degree more kink", 1.0),
    "evenness": ("0.1 % more unevenness", 0.1),
    "drift_along": ("1 % more drift along", 1.0),
    "drift_across": ("1 % more drift across", 1.0),
    "drift_outline": ("0.1 % more drift of the outline", 0.1),
}
# Seams that are named for what they cost: as many as make up so much of it, or no more than these.
_MOST_OF_IT, _MOST_SEAMS = 0.5, 3
_METHODS = {"local": "each alone", "two_stage": "two-stage", "concurrent": "concurrent", "annealing": "annealing"}

_HELD = "Tolerance and limits"
_MEASURES: tuple[tuple[str, Callable[[SummaryModel], str], str], ...] = (
    ("Largest corner gap, mm", lambda s: length(s.max_corner_gap), "at corners and bend lines"),
    ("Largest seam gap, mm", lambda s: length(s.max_seam_gap), "along the whole seam"),
    ("  width", lambda s: length(s.max_width), "joint too wide or narrow"),
    ("  step", lambda s: length(s.max_step), "one panel stands out"),
    ("  shift", lambda s: length(s.max_shift), "edges out of line"),
    ("RMS deviation, mm", lambda s: length(s.rms_deviation), "from the drawing, on average"),
    ("  against each alone", lambda s: multiple(s.local_rms_multiple), "1 if seams cost nothing"),
    ("Largest deviation, mm", lambda s: length(s.max_deviation), "at the worst place"),
    ("Hausdorff distance, mm", lambda s: length(s.hausdorff), "both ways, with edges"),
)


def rows(summaries: Sequence[SummaryModel], *, held: bool = True) -> Iterator[tuple[str, list[str], str]]:
    """The headings and numbers of a table with one column a summary, and what each row means, in a few words.

    Args:
        summaries: the columns.
        held: whether there was a tolerance that may be met or not.
    """
    for heading, show, meaning in _MEASURES:
        yield heading, [show(summary) for summary in summaries], meaning
    for row in (row for limit in LIMITS for row in limit.rows):
        found = [getattr(summary, row.key) for summary in summaries]
        if any(value is not None for value in found):
            yield row.heading, [DASH if value is None else row.form.format(value) for value in found], row.meaning
    if held:
        yield _HELD, ["met" if summary.tolerance_met else "not met" for summary in summaries], ""


def headings() -> list[str]:
    """Of all rows that `rows` may have."""
    return [*(heading for heading, _, _ in _MEASURES), *(row.heading for limit in LIMITS for row in limit.rows), _HELD]


def length(value: float) -> str:
    """Millimetres, with the digits that matter."""
    return f"{value:.3f}" if value < 10.0 else f"{value:.2f}"


def multiple(value: float | None) -> str:
    """A ratio, or a dash where there is nothing to divide by."""
    return DASH if value is None else f"{value:.2f} x"


def console() -> Console:
    """Standard output; a file or a pipe gets lines wide enough for the tables."""
    own_width = sys.stdout.isatty() or "COLUMNS" in os.environ
    return PrintableConsole(None if own_width else 120)


def print_report(report: ReportModel, folder: Path, took: float, *, verbose: bool = False) -> None:
    """The table at the end of a fit, the certificate, where it all is and how many seconds it took.

    Args:
        report: of the delivery.
        folder: that it lies in.
        took: seconds.
        verbose: hold it against the two baselines, too.
    """
    out = console()
    out.print()
    out.print(_closing_table(report, verbose=verbose))
    if len(report.features) > 1:
        counts = ", ".join(f"{count} {name}" for name, count in report.features.items())
        out.print(Text(f"Panels by feature: {counts}."))
    bends = _bends(report)
    if bends:
        out.print(Text(bends))
    for line in _rules(report):
        out.print(Text(line))
    traded = _traded(report)
    if traded:
        out.print(Text(traded))
    kinked = _kinked(report)
    if kinked:
        out.print(Text(kinked))
    print_certificate(report.certificate, "Certificate")
    notes = [f"Note: {note}" for note in report.reference.notes]
    notes += [f"Note on panel '{panel.name}': {note}" for panel in report.panels for note in panel.notes]
    for note in notes[:_MOST_NOTES]:
        out.print(Text(note))
    if len(notes) > _MOST_NOTES:
        out.print(Text(f"{counted(len(notes) - _MOST_NOTES, 'more note')} in {REPORT}."))
    for line in worst_lines(report):
        out.print(Text(line))
    if (folder / PAGE).is_file():
        out.print(Text(f"Look at it: cadpanel view {folder}"), soft_wrap=True)
    out.print(Text(f"Written: {folder} in {took:.1f} s ({seconds(report.timing)}; the rest to start)"), soft_wrap=True)


def _closing_table(report: ReportModel, *, verbose: bool) -> Table:
    """One row a measure: this result and what it means or, for who asks, the two baselines before it."""
    settings, baselines = report.settings, report.baselines
    table = Table(title=title(report), title_justify="left", title_style="bold", show_header=verbose)
    table.add_column("")
    columns = [baselines.local, baselines.two_stage, report.summary] if verbose else [report.summary]
    for heading in ("each alone", "two-stage") if verbose else ():
        table.add_column(heading, justify="right", style="dim")
    table.add_column(f"this result ({_METHODS[settings.method]})", justify="right", style="bold")
    for heading, numbers, meaning in rows(columns, held=settings.weights is None):
        table.add_row(heading, *map(_marked, numbers), *(() if verbose else (meaning,)))
    return table


def worst_lines(report: ReportModel) -> list[str]:
    """Which panel and which seam are worst, and by how much."""
    panel = max(report.panels, key=lambda one: one.max_deviation)
    lines = [
        f"Worst panel: '{panel.name}', up to {length(panel.max_deviation)} mm from the drawing "
        f"(RMS {length(panel.rms_deviation)} mm)."
    ]
    if report.seams:
        seam = max(report.seams, key=lambda one: one.max_seam_gap)
        first, second = seam.panels
        lines.append(
            f"Worst seam: '{first}' - '{second}', gap up to {length(seam.max_seam_gap)} mm "
            f"(width {length(seam.width)}, step {length(seam.step)}, shift {length(seam.shift)} mm)."
        )
    return lines


def _rules(report: ReportModel) -> Iterator[str]:
    """What came of each rule; of those that hold no more than a few."""
    shown = [rule for rule in report.rules if not rule.kept]
    shown += [rule for rule in report.rules if rule.kept][:_MOST_NOTES]
    for rule in shown:
        unit = f" {rule.unit}" if rule.unit else ""
        yield (
            f"Rule {'held' if rule.kept else 'NOT held'}: {rule.rule}; {rule.measure} {rule.found:.3g}{unit}, at most "
            f"{rule.allowed:.3g}{unit}."
        )
    if len(report.rules) > len(shown):
        yield f"{counted(len(report.rules) - len(shown), 'more rule')} held, in {REPORT}."


def _traded(report: ReportModel) -> str:
    """What the limits that cost most cost, in one line."""
    prices = {name: price * _WORTH[name][1] for name, price in report.solve.prices.items() if name in _WORTH}
    dear = sorted((name for name, saved in prices.items() if saved >= _WORTH_TELLING), key=lambda name: -prices[name])
    if not dear:
        return ""
    told = ", ".join(f"{prices[name]:.2f} mm for {_WORTH[name][0]}" for name in dear[:3])
    return f"What limits cost: RMS deviation would fall at first by about {told}.{_dear_seams(report, dear)}"


def _dear_seams(report: ReportModel, dear: Sequence[str]) -> str:
    """The seams on which most of the price of gaps falls, where it is one of those that are told."""
    each = sorted(((seam.price or 0.0, seam.panels) for seam in report.seams), key=lambda one: -one[0])
    whole = sum(price for price, _ in each)
    if not set(dear[:3]) & set(report.settings.gaps) or whole <= 0.0:
        return ""
    shown, share = [], 0.0
    for price, panels in each[:_MOST_SEAMS]:
        shown.append("|".join(panels))
        share += price / whole
        if share >= _MOST_OF_IT:
            break
    return f" Of what gaps cost {100.0 * share:.0f} % falls on {counted_seams(len(shown))} {', '.join(shown)}."


def counted_seams(count: int) -> str:
    """As a sentence goes on to their names."""
    return "the seam" if count == 1 else "the seams"


def _kinked(report: ReportModel) -> str:
    """The largest kink and its seam, where people see it: light breaks there."""
    worst = max(report.seams, key=lambda seam: seam.max_kink, default=None)
    if worst is None or worst.max_kink <= _KINK_SEEN:
        return ""
    first, second = worst.panels
    return (
        f"The largest kink, {worst.max_kink:.1f} degrees, is between '{first}' and '{second}'; light shows kinks of "
        f"more than {_KINK_SEEN:g}. --max-kink holds them below a limit."
    )


def _bends(report: ReportModel) -> str:
    """What was taken for the bends between two flanges, and nothing where panels have none, or several."""
    widths, whole = [], []
    for panel in report.panels:
        # Returns are no part of the drawing.
        patches = fitted_patches(panel)
        curved = [index for index, patch in enumerate(patches) if patch.kind != "plane"]
        if not curved or curved != list(range(1, len(patches) - 1)):
            return ""
        for end in panel.taken:
            widths.append(end[curved[-1] + 1] - end[curved[0]])
            whole.append(end[-1])
    return (
        f"Taken for the bend: {min(widths):.0f} to {max(widths):.0f} mm of widths of {min(whole):.0f} to "
        f"{max(whole):.0f} mm; where, is in {REPORT}, and --blend overrides it."
    )


def title(report: ReportModel) -> str:
    """What was fitted, and how."""
    reference, settings = report.reference, report.settings
    return (
        f"{reference.file}: {counted(reference.panels, 'panel')}, {counted(reference.seams, 'seam')}, "
        f"{settings.feature}, {asked_of_gaps(settings)}"
    )


def asked_of_gaps(settings: ComparisonSettingsModel) -> str:
    """What was held of gaps."""
    if settings.weights is not None:
        return "weights"
    names = {
        "gap": "gap tolerance {:g} mm",
        "width": "joints +-{:g} mm",
        "step": "step {:g} mm",
        "shift": "shift {:g} mm",
    }
    return ", ".join(names[what].format(most) for what, most in settings.gaps.items())


def print_certificate(certificate: CertificateModel, heading: str) -> None:
    """What the files showed when they were read back."""
    faces = certificate.face_kinds.items()
    kinds = ", ".join(counted(count, f"{kind} face") for kind, count in faces if count) or "no faces"
    said = (
        f"{counted(certificate.solids, 'solid')} {'valid' if certificate.valid else 'NOT valid'} ({kinds}), "
        f"names {'kept' if certificate.names_kept else 'NOT kept'}, "
        f"tangent to {certificate.max_tangency_error:.1g} rad, volumes to {certificate.volume_error:.1g}, "
        f"seams open by at most {length(certificate.max_seam_gap)} mm in the files{_joints(certificate)}."
    )
    console().print(Text(f"{heading}: {said}"))
    if certificate.holes:
        holes = counted(certificate.holes, "fixing hole")
        console().print(Text(f"{holes}, within {certificate.hole_error:.1g} mm of the flat patterns' circles."))
    drawn = certificate.outputs.get("flats")
    if drawn is not None:
        said = (
            f"{counted(round(drawn['drawings']), 'drawing')}, {counted(round(drawn['audit_errors']), 'fault')} in "
            f"ezdxf's audit, areas to {certificate.flat_area_error:.1g}, edges to "
            f"{certificate.flat_length_error:.1g} mm, contours within {drawn['contour_error']:.2g} mm."
        )
        console().print(Text(f"Flat patterns: {said}"))


def _joints(certificate: CertificateModel) -> str:
    """What is said of the joints between sheets; nothing where none was proved."""
    if certificate.clear is None or certificate.overlap is None:
        return ""
    least, largest = (length(width) for width in (certificate.clear.least, certificate.clear.largest))
    return f", joints {least} to {largest} mm wide, no two solids share volume"


def counted(count: int, thing: str) -> str:
    """One thing, several things."""
    return f"{count} {thing}" if count == 1 else f"{count} {thing}s"


def seconds(timing: TimingModel) -> str:
    """What each step took; the rest of the time goes into starting the CAD kernel."""
    steps = ("read", "fit", "build", "write", "verify")
    return ", ".join(f"{step} {getattr(timing, step):.1f}" for step in steps)


def print_comparison(comparison: ComparisonModel) -> None:
    """The paper's Table 1: one row a seam, then what the gaps cost."""
    settings = comparison.settings
    table = Table(
        title=f"{comparison.reference.file}: largest corner gap of each seam, mm ({asked_of_gaps(settings)})",
        title_justify="left",
        title_style="bold",
    )
    table.add_column("Seam", overflow="fold")
    for column in comparison.columns:
        table.add_column(f"{_METHODS[column.method]}\n{_in_two_lines(column.feature)}", justify="right")
    for index, (first, second) in enumerate(comparison.seams):
        table.add_row(Text(f"{first} - {second}"), *(length(c.max_corner_gap[index]) for c in comparison.columns))
    table.add_section()
    for heading, numbers, _ in rows([column.summary for column in comparison.columns]):
        table.add_row(heading, *map(_marked, numbers))
    table.add_section()
    table.add_row("RMS of each panel alone, mm", *(length(c.local_rms_deviation) for c in comparison.columns))
    table.add_row("Time of the fit, s", *(f"{column.seconds:.1f}" for column in comparison.columns))
    out = console()
    out.print()
    out.print(table)


def _in_two_lines(feature: str) -> str:
    """Four columns of whole feature names would not fit on a screen."""
    head, dash, tail = feature.rpartition("-")
    return f"{head}{dash}\n{tail}"


def _marked(value: str) -> Text:
    return Text(value, style="bold red" if value == "not met" else "")
