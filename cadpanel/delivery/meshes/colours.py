"""What colours tell on panels: which feature they have, or how far they deviate from the drawing."""

from __future__ import annotations

from collections.abc import Sequence

from cadpanel.delivery.records.report import PanelModel
from cadpanel.delivery.shop_settings import MeshColours

Colour = tuple[float, float, float]
FEATURES: tuple[Colour, ...] = (
    (0.55, 0.63, 0.70),
    (0.84, 0.70, 0.42),
    (0.47, 0.67, 0.56),
    (0.78, 0.52, 0.45),
    (0.62, 0.55, 0.74),
    (0.72, 0.74, 0.46),
    (0.42, 0.62, 0.74),
    (0.74, 0.60, 0.65),
)
"""One a feature, sRGB, in the order in which features are met; from the ninth on they begin again."""
LEAST, MOST = (0.93, 0.91, 0.84), (0.70, 0.15, 0.16)
"""Of a panel that does not deviate, and of the one that does most."""


def colours_of(panels: Sequence[PanelModel], tell: MeshColours) -> list[Colour]:
    """A colour for each panel, as the settings say what colours tell."""
    return by_deviation(panels) if tell == "deviation" else by_feature(panels)


def by_feature(panels: Sequence[PanelModel]) -> list[Colour]:
    """A colour for each panel, the same for the same feature."""
    features = list(dict.fromkeys(panel.feature for panel in panels))
    return [FEATURES[features.index(panel.feature) % len(FEATURES)] for panel in panels]


def by_deviation(panels: Sequence[PanelModel]) -> list[Colour]:
    """A colour for each panel, by its largest deviation as a share of the largest of all."""
    most = max((panel.max_deviation for panel in panels), default=0.0)
    return [_between(panel.max_deviation / most if most > 0.0 else 0.0) for panel in panels]


def _between(share: float) -> Colour:
    red, green, blue = (low + share * (high - low) for low, high in zip(LEAST, MOST, strict=True))
    return red, green, blue
