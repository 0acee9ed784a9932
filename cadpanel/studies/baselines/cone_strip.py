"""Every panel as cones along the strip through its tangent planes, without any fit (Leopoldseder and Pottmann).

Where the panel has flat sides, these are planes. The ends are cut in planes through the drawn ones.
"""

from __future__ import annotations

from dataclasses import dataclass

from cadpanel.errors import LoftError, PanelError
from cadpanel.features.feature import Feature
from cadpanel.features.patches import Cone, Plane
from cadpanel.fitting.measures.fit import measure
from cadpanel.fitting.problem import pose
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.fitting.start.cone_strips import cones_of, strips_of
from cadpanel.lofting.tangent_planes import Sampled
from cadpanel.reference.model import Reference
from cadpanel.studies.baselines.baseline import Baseline, Outcome


@dataclass(frozen=True, slots=True)
class ConeStrip(Baseline):
    """Cones along strips.

    Attributes:
        cones: how many a panel, an even number.
    """

    cones: int = 4

    def run(self, reference: Reference) -> Outcome:
        """See `Baseline`."""
        bend = self.cones * [Cone()]
        whole, flanged = Feature(*bend, name="cones"), Feature(Plane(), *bend, Plane(), name="plane-cones-plane")
        samples = [sampled for sampled, _ in strips_of(reference)]
        features = [flanged if _flat(sampled) else whole for sampled in samples]
        for panel, of, sampled in zip(reference.panels, features, samples, strict=True):
            try:
                cones_of(of, panel, sampled)  # without them the start would be another
            except LoftError as error:
                raise PanelError(panel.name, str(error)) from error
        problem, starts = pose(reference, features)
        return Outcome.of(measure(panel_shapes(problem, starts[-1]), reference))


def _flat(sampled: Sampled) -> bool:
    return sampled.turning() != sampled.whole_turning
