"""The beam's matrices against scikit-fem's assembly of the same weak forms (verification)."""

from __future__ import annotations

import numpy as np
import pytest

from cuefem import Joint, PointMass, Resolution, Support
from cuefem.beam import weak_forms
from cuefem.beam.assembly import assemble
from cuefem.beam.modes import solve
from studies.strokes import NAMES, cue

EFFECTS = {
    "free": (),
    "mass, springs": (PointMass(position=0.0, mass=2e-3), Support(0.2, stiffness=5e3, rotational_stiffness=3.0)),
    "clamp, joint": (Support(0.55, stiffness=np.inf), Joint(0.31, rotational_compliance=1e-3)),
    "fixed": (Support(0.6, np.inf, np.inf), Joint(0.25, rotational_compliance=2e-3, shear_compliance=1e-6)),
    "stiff joint": (Joint(0.5, 0.0, 3.5e-202),),
}


@pytest.mark.parametrize(
    ("name", "support"), [*((name, "free") for name in NAMES), *(("kim", key) for key in EFFECTS if key != "free")]
)
def test_frequencies_equal_scikit_fem_of_same_weak_forms(name: str, support: str) -> None:
    """Twelve flexible modes on one mesh, to 1e-9: the bases differ, the spaces are the same."""
    shaft, order, effects = cue(name), 8, EFFECTS[support]
    system = assemble(shaft, Resolution(2, order, 12), effects)
    solution = solve(system, 12)
    K, M = weak_forms.assemble(shaft, system.mesh.nodes, order=order, effects=effects)
    frequencies = weak_forms.frequencies(K, M, shift=system.shift)[solution.rigid : solution.rigid + 12]
    np.testing.assert_allclose(frequencies, solution.frequencies, rtol=1e-9)
