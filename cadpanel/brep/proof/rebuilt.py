"""Sheets and skins in the files, held one to one against what the report's numbers make."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.brep.proof.boundary import Boundary, difference
from cadpanel.brep.proof.same_boundaries import same_boundaries
from cadpanel.brep.proof.shape_facts import ShapeFacts
from cadpanel.errors import PanelError


@dataclass(frozen=True, slots=True, kw_only=True)
class Rebuilt:
    """A panel's sheet and its skin, built from the report's numbers."""

    solid: Boundary
    skin: Boundary


def unlike_rebuilt(
    names: Sequence[str],
    built: Sequence[Rebuilt | PanelError],
    solids: Mapping[str, ShapeFacts],
    skins: Mapping[str, ShapeFacts],
) -> Iterator[str]:
    """One sentence for every sheet and every skin in the files that is not what was built anew.

    Args:
        names: of the panels.
        built: each of them, anew, or why it cannot be built.
        solids: by name, what the files hold.
        skins: the same of the skins.
    """
    for name, own in zip(names, built, strict=True):
        if isinstance(own, PanelError):
            yield f"Panel '{name}': no sheet can be built from the numbers in the report ({own.reason.rstrip('.')})."
    known = [(name, own) for name, own in zip(names, built, strict=True) if isinstance(own, Rebuilt)]
    pairs = [("solid", name, solids[name].boundary, own.solid) for name, own in known if name in solids]
    pairs += [("skin", name, skins[name].boundary, own.skin) for name, own in known if name in skins]
    same = same_boundaries([found for _, _, found, _ in pairs], [wanted for _, _, _, wanted in pairs])
    for place in np.flatnonzero(~same).tolist():
        label, name, found, wanted = pairs[place]
        fault = difference(found, wanted)
        if fault is not None:
            yield f"Panel '{name}': its {label} is not what the numbers in the report make: it {fault}."
