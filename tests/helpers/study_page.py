"""A study's page as wide as those of studies/sweeps, without computing a cue."""

from __future__ import annotations

import numpy as np

from cuefem.design import Response
from cuefem.report.study_page import study_page
from cuefem.report.study_table import StudyTable


def study_of_ten_columns() -> str:
    """The page of a sweep over three columns with seven responses, as wide as those in studies/sweeps."""
    bore, deep, time = (x.ravel() for x in np.meshgrid([2.0, 5.0, 9.0], [50.0, 140.0], [0.8, 1.2], indexing="ij"))
    kinds = ("end_mass", "squirt(0.3)", "pivot_length", "tip_stiffness", "shaft_mass", "balance_point", "frequency(1)")
    responses = tuple(Response.of(kind) for kind in kinds)
    results = np.stack([time - 0.1 * bore, -bore, bore, -bore, -bore, bore, bore], axis=1)
    names, units = ("bore", "bore depth", "tip.contact_time"), ("m", "m", "s")
    values = (1e-3 * bore, 1e-3 * deep, 1e-3 * time)
    return study_page("bore", StudyTable(names, units, responses, np.arange(12), values, results), ["12 designs"])
