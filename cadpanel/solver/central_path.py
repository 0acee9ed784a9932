"""The weight that a number has on the central path, and the smooth penalty whose slope that weight is.

min f + nu p with c <= p and p >= 0, the bounds as logarithms: f + nu p - mu log p - mu log(p - c). With the multipliers
w of c <= p and nu - w of p >= 0 the conditions of a minimum are w (p - c) = mu and (nu - w) p = mu, so that
c = mu / (nu - w) - mu / w: one c for every w between 0 and nu. Minimised over p, the penalty is a smooth function of c
whose slope is w. It is exact: beyond c = 0 it rises by nu at most, so that what cannot be held gives way instead of
drowning the rest (Fletcher, Practical Methods of Optimization, 2nd ed. 1987, section 14.3; Wright, Primal-Dual
Interior-Point Methods, 1997).
"""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array

_NEARLY_NONE = 1e-300
# What is left of the greatest weight at least: also a tenth of it is to be seen beside that weight.
_NEARLY_ALL = 1e-14


def central_weight(c: Array, mu: Array | float, most: Array) -> Array:
    """The w between 0 and `most` = nu at which c = mu / (nu - w) - mu / w."""
    m = mu / most
    # With w = nu y: c y^2 + (2 m - c) y - m = 0, solved such that nothing cancels.
    slope = 2.0 * m - c
    root = np.sqrt(slope**2 + 4.0 * c * m)
    share = np.where(
        slope > 0.0, 2.0 * m / np.maximum(slope + root, _NEARLY_NONE), 1.0 - 2.0 * m / (np.abs(c) + 2.0 * m + root)
    )
    weight: Array = most * np.clip(share, _NEARLY_NONE, 1.0 - _NEARLY_ALL)
    return weight


def penalty(c: Array, mu: Array | float, most: Array) -> Array:
    """The least of nu p - mu log p - mu log(p - c) over p, but for what does not depend on c."""
    weight = central_weight(c, mu, most)
    # p = mu / (nu - w) and p - c = mu / w; nu p = mu + w p and w p = w c + mu.
    least: Array = weight * c + mu * (np.log(weight / most) + np.log(np.maximum(1.0 - weight / most, _NEARLY_NONE)))
    return least
