"""Strips one after the other, each as wide as the largest deviation allows."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from cadpanel.errors import PanelError, SettingsError
from cadpanel.fitting.result import FitResult
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.assemble import assemble
from cadpanel.reference.model import FaceSamples, RawPanel, Reference
from cadpanel.studies import widest_strips as module
from cadpanel.studies.widest_strips import Cuts, Widest, _off, widest_strips
from tests.thorough import thorough

# Of the barrels, mm: along the strip, and across.
LENGTH, WIDTH = 9000.0, 1500.0
FLAT = FitSettings(feature="planar-quadrilateral", seam_turn=90.0, max_deviation=4.0)


class Barrel:
    """A strip round a barrel whose radius is one on its first half and another on the second.

    Attributes:
        reads: how often it was cut.
    """

    def __init__(self, first: float, second: float) -> None:
        self._angles, self._radii, self.reads = 0.5 * LENGTH / np.array([first, second]), (first, second), 0

    def _at(self, place: np.ndarray, across: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        first, second = self._radii
        angle = np.minimum(place / first, self._angles[0])
        after = np.maximum(place - 0.5 * LENGTH, 0.0) / second
        turned = angle + after
        meet = self._angles[0]
        x = first * np.sin(angle) + second * (np.sin(turned) - np.sin(np.where(after > 0.0, meet, turned)))
        z = first * np.cos(angle) + second * (np.cos(turned) - np.cos(np.where(after > 0.0, meet, turned)))
        return np.stack([x, across, z], axis=-1), np.stack([np.sin(turned), 0.0 * turned, np.cos(turned)], axis=-1)

    def __call__(self, cuts: Cuts) -> Reference:
        """It, cut at such lengths."""
        self.reads += 1
        ends = [0.0, *cuts, LENGTH]
        panels = [RawPanel(name=f"B-{i + 1:02d}", faces=(self._face(*pair),)) for i, pair in enumerate(pairwise(ends))]
        return assemble(panels, source="barrel")

    def _face(self, start: float, stop: float) -> FaceSamples:
        share = (np.arange(12) + 0.5) / 12
        place, across = (a.ravel() for a in np.meshgrid(start + (stop - start) * share, WIDTH * share))
        line = np.linspace(0.0, 1.0, 33)
        on = start + (stop - start) * line
        loop = [
            (on, 0.0 * line),
            (stop + 0.0 * line, WIDTH * line),
            (on[::-1], WIDTH + 0.0 * line),
            (start + 0.0 * line, WIDTH * line[::-1]),
        ]
        edges = [self._at(*edge) for edge in loop]
        points, normals = self._at(place, across)
        return FaceSamples(
            points=points,
            normals=normals,
            weights=np.full(len(points), (stop - start) * WIDTH / len(points)),
            edges=tuple(edge[0] for edge in edges),
            edge_normals=tuple(edge[1] for edge in edges),
        )


def found(first: float, second: float, settings: FitSettings = FLAT) -> tuple[Widest, Barrel]:
    read = Barrel(first, second)
    return widest_strips(read, settings), read


def flat_width(radius: float, off: float) -> float:
    """A plane of least squares lies 2/3 of an arc's rise, r (1 - cos a), off its ends: so 3/2 of `off` is allowed."""
    return 2.0 * radius * float(np.arccos(1.0 - 1.5 * off / radius))


def test_flat_panels_round_a_barrel_are_as_wide_as_their_rise_allows() -> None:
    strips, _ = found(20_000.0, 20_000.0)
    expected = flat_width(20_000.0, strips.bound)
    assert strips.result.tolerance_met
    assert strips.result.measures.max_deviation.max() <= 4.0
    assert np.array(strips.widths[:-1]) == pytest.approx(expected, rel=0.04)
    assert 0.0 < strips.widths[-1] <= 1.04 * expected
    assert sum(strips.widths) == pytest.approx(LENGTH, rel=1e-3)
    assert "as wide as" in strips.result.reference.notes[-1]


def test_panels_are_wide_where_the_strip_bends_little_and_narrow_where_it_bends_much() -> None:
    strips, read = found(20_000.0, 5_000.0)
    first, last = strips.widths[0], strips.widths[-2]
    assert first / last == pytest.approx(2.0, rel=0.08)
    # Few tries a panel.
    assert read.reads <= 8 * len(strips.widths) + 10


def test_a_strip_that_needs_no_cut_has_none() -> None:
    strips, _ = found(20_000.0, 20_000.0, FitSettings(feature="cylinder", max_deviation=4.0))
    assert strips.stations == ()
    assert strips.result.measures.max_deviation.max() < 0.1


def test_without_a_deviation_or_with_two_strips_there_is_nothing_to_look_for() -> None:
    with pytest.raises(SettingsError, match="give one"):
        widest_strips(Barrel(1e4, 1e4), FitSettings())
    both = Barrel(1e4, 1e4)((4000.0,))
    with pytest.raises(SettingsError, match="2 surfaces"):
        widest_strips(lambda _: both, FLAT)


@thorough
def test_a_bound_much_tighter_than_it_need_be_is_widened_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Fewer than seven panels miss, and by so much that the next bound leaps far below the one that would hold."""

    def missing(reference: Reference, settings: FitSettings, *, time_limit: float | None = None) -> FitResult:
        if 1 < len(reference.panels) < 7:
            settings = replace(settings, max_deviation=0.04)
        return fit(reference, settings, time_limit=time_limit)

    monkeypatch.setattr(module, "fit", missing)
    times = {0.04: 25.0}
    monkeypatch.setattr(module, "_off", lambda result: _off(result) * times.get(result.settings.max_deviation, 1.0))
    strips, _ = found(5_000.0, 5_000.0, replace(FLAT, max_deviation=60.0))
    assert strips.result.tolerance_met
    assert 7 <= len(strips.widths) <= 9


@thorough
def test_panels_too_wide_to_be_fitted_together_are_made_narrower_or_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    fewest = 4

    def refusing(reference: Reference, settings: FitSettings, *, time_limit: float | None = None) -> FitResult:
        if 1 < len(reference.panels) < fewest:
            raise PanelError("B-01", "no plane comes near it")
        return fit(reference, settings, time_limit=time_limit)

    monkeypatch.setattr(module, "fit", refusing)
    strips, _ = found(5_000.0, 5_000.0, replace(FLAT, max_deviation=1e6))
    assert strips.result.tolerance_met
    assert len(strips.widths) >= fewest
    fewest = 1000
    monkeypatch.setattr(module, "_ROUNDS", 1)
    with pytest.raises(SettingsError, match=r"allow less \(Panel 'B-01'"):
        found(5_000.0, 5_000.0, replace(FLAT, max_deviation=1e6))
