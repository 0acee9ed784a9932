"""What has to be done with settings once the reference is known that they are for."""

from __future__ import annotations

from collections.abc import Callable

from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.model import Reference

Prepare = Callable[[FitSettings, Reference], FitSettings]
"""Gives the settings for one reference: rules that lock panels to an earlier delivery are read from it there."""


def unprepared(settings: FitSettings, reference: Reference) -> FitSettings:
    """The settings as they are."""
    del reference
    return settings
