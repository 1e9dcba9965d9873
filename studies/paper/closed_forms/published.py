"""Formulas of other authors: [Shepard]; and what "b" each of them means. [A.31], [B.1]: cuefem.results.closed_forms."""

from __future__ import annotations

from typing import Any

import numpy as np

from cuefem.quantity.fields import sine_cosine
from studies.paper.closed_forms.arguments import checked


def shepard(offset: Any, *, mass_ratio: Any, inertia: Any = 0.4) -> Any:
    """[Shepard] as [Kim] prints it: squirt, rad, with b/R measured to the force's line; mass_ratio M/m_e.

    tan psi = (sin cos/nu)/(1 + M/m_e + sin^2/nu): [A.31] exactly, with b the offset of the line of force.
    """
    offset, ratio, nu = checked(offset=offset, mass_ratio=mass_ratio, inertia=inertia)
    s, c = sine_cosine(offset)
    return np.arctan(s * c / nu / (1 + ratio + s**2 / nu))
