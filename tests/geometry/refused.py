"""What refuses a panel: with a reason, and the panel's name."""

from __future__ import annotations

from typing import Any

import pytest

from cadpanel.errors import PanelError
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.sheet_checks import check_buildable


def refused(shape: Panel, reason: str, thickness: float = 3.0, skin_side: Any = "outer") -> None:
    """No sheet can be built of a shape, for a reason (a pattern) that names the panel."""
    with pytest.raises(PanelError, match=reason) as caught:
        check_buildable(shape, thickness, skin_side)
    assert caught.value.panel == shape.name
    assert caught.value.reason.count(".") >= 1
