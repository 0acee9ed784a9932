"""What `fit` and `study` give to a Python program: results that can be looked at."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

from cadpanel.delivery.records.study import StudyModel
from cadpanel.errors import SettingsError
from cadpanel.fitting import result as fitting
from cadpanel.kinds import checked

if TYPE_CHECKING:
    import pandas
    from matplotlib.figure import Figure

    from cadpanel.delivery.page.scene import Scene, SeamScene
    from cadpanel.delivery.pictures.colours import Colour
    from cadpanel.delivery.pictures.views import View

_AS_THICK = 3.0
"""mm: the sheets of a picture of panels that are not built yet."""


@dataclass(frozen=True, slots=True, repr=False)
class FitResult(fitting.FitResult):
    """A fit's result, with pictures of it; they need matplotlib (pip install 'cadpanel[plot]').

    `result["NW-01"]` is a panel's shape; a result has a length and can be gone through, panel by panel. In a notebook
    it shows itself as the page of a delivery does.
    """

    @staticmethod
    def of(found: fitting.FitResult) -> FitResult:
        """The same result with pictures."""
        return FitResult(**{one.name: getattr(found, one.name) for one in fields(fitting.FitResult)})

    @checked
    def plot(self, color: Colour = "deviation", view: View = "outside") -> Figure:
        """All panels.

        Args:
            color: "deviation", "gap", "step", "kink", "feature" or "radius".
            view: "outside", "north", "east", "south", "west" or "top".

        Raises:
            SettingsError: matplotlib is missing, or there is no such colour or view.
        """
        from cadpanel.delivery.pictures.model import draw_model

        return draw_model(self._scene(), color, view)

    @checked
    def plot_deviation(self, view: View = "outside") -> Figure:
        """All panels, coloured by how far the reference lies inside or outside of them.

        Raises:
            SettingsError: matplotlib is missing, or there is no such view.
        """
        return self.plot("deviation", view)

    @checked
    def plot_seam(self, first: str, second: str) -> Figure:
        """Gap, width, step and kink along the seam between two panels; the one with the larger gap if there are two.

        Raises:
            KeyError: there is no such panel, or the two do not meet.
            SettingsError: matplotlib is missing.
        """
        from cadpanel.delivery.pictures.seam import draw_seam

        for name in (first, second):
            self.shape(name)
        met = [seam for seam in self._scene().seams if set(seam.panels) == {first, second}]
        if not met:
            raise KeyError(f"'{first}' and '{second}' do not meet along a seam")
        return draw_seam(max(met, key=_largest_gap))

    @checked
    def plot_flat(self, name: str) -> Figure:
        """The flat pattern of a panel's skin, seen from outside.

        Raises:
            KeyError: there is no such panel.
            SettingsError: matplotlib is missing.
        """
        from cadpanel.delivery.pictures.flat import draw_flat
        from cadpanel.geometry.unroll import unroll

        return draw_flat(unroll(self.shape(name)))

    @checked
    def to_dataframe(self) -> pandas.DataFrame:
        """One row a panel under its name: feature, deviations and drift in mm, area in m2; needs pandas.

        Raises:
            SettingsError: pandas is missing.
        """
        try:
            import pandas as pd
        except ImportError as error:
            raise SettingsError("tables need pandas: install it with pip install 'cadpanel[dataframe]'") from error
        measures = self.measures
        columns = {
            "feature": [shape.feature for shape in self.shapes],
            "rms_deviation": measures.rms_deviation,
            "max_deviation": measures.max_deviation,
            "corner_drift": measures.drift,
            "area": [1e-6 * shape.area() for shape in self.shapes],
        }
        return pd.DataFrame(columns, index=pd.Index([shape.name for shape in self.shapes], name="panel"))

    def _scene(self) -> Scene:
        from cadpanel.delivery.page.scene import scene_of

        return scene_of(self, self.shapes, [shape.offset(-_AS_THICK) for shape in self.shapes])

    def _repr_html_(self) -> str:
        """The page of a delivery, in a frame."""
        from cadpanel.delivery.page.notebook import frame_of_fit

        return frame_of_fit(self, self._scene())


def _largest_gap(seam: SeamScene) -> float:
    return float(seam.profile.gap.max())


class Study(StudyModel):
    """What `study` found, with a picture of it."""

    @staticmethod
    def of(found: StudyModel) -> Study:
        """The same study with a picture."""
        return Study.model_validate(found.model_dump(by_alias=True))

    def plot(self) -> Figure:
        """Deviation over gaps, one line for each feature and number of panels, its knee marked.

        Raises:
            SettingsError: matplotlib is missing.
        """
        from cadpanel.delivery.pictures.colours import require_matplotlib
        from cadpanel.delivery.study_plot import draw_study

        require_matplotlib()
        return draw_study(self)
