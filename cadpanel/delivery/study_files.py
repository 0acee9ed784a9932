"""All files of a study, in a folder."""

from __future__ import annotations

from pathlib import Path

from cadpanel.delivery.own_files import STUDY, STUDY_PLOTS, STUDY_TABLE
from cadpanel.delivery.records.study import StudyModel, write_study
from cadpanel.delivery.study_plot import MISSING, can_plot, plot_study


def write_study_files(study: StudyModel, folder: Path) -> str:
    """Write study.json and study.csv, and the plot where it can be drawn.

    Returns:
        What is missing and how it is to be had, in one sentence; empty where nothing is.

    Raises:
        DeliveryError: a file cannot be written.
    """
    write_study(study, folder / STUDY, folder / STUDY_TABLE)
    if not can_plot():
        return MISSING
    plot_study(study, [folder / name for name in STUDY_PLOTS])
    return ""
