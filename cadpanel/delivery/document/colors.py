"""Colours by a number: dark for little, light for much, and apart in grey, too."""

from __future__ import annotations

from cadpanel.delivery.document.objects import Color

# From dark violet through green to yellow, sRGB; without near-white, which lamps wash out.
STOPS: tuple[Color, ...] = (
    (0.27, 0.00, 0.33),
    (0.23, 0.32, 0.55),
    (0.13, 0.57, 0.55),
    (0.37, 0.79, 0.38),
    (0.99, 0.91, 0.14),
)
SEAM: Color = (0.80, 0.10, 0.10)
SKIN: Color = (0.62, 0.68, 0.73)
FLAT: Color = (0.76, 0.72, 0.65)


def ramp(share: float) -> Color:
    """The colour at a share of the way from the least to the largest number, in equal steps between the stops."""
    place = min(max(share, 0.0), 1.0) * (len(STOPS) - 1)
    step = min(int(place), len(STOPS) - 2)
    red, green, blue = (
        low + (high - low) * (place - step) for low, high in zip(STOPS[step], STOPS[step + 1], strict=True)
    )
    return red, green, blue


def share(value: float, least: float, largest: float) -> float:
    """Where a number lies between the least and the largest one; 0 where they are the same."""
    return 0.0 if largest <= least else (value - least) / (largest - least)
