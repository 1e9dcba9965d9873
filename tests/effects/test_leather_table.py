"""The committed table of the leather tip is what its program gives (regression)."""

from __future__ import annotations

import numpy as np
import pytest

from cuefem.solid import leather_table as lt
from cuefem.solid.leather_table import Flat, OwnTip
from cuefem.solid.tip_sheets import gains, own_tip
from cuefem.solid.tip_solid import Shape
from studies.beam.leather_elasticity import COUNTS, shape_at

LARGEST = (0.0252, 0.0068)  # the page's, of patches within the rim and head on; 95 of 100 are below half a per cent
NUS = (1 - np.exp(-lt.nodes(*lt.NU, COUNTS["nu"]))) / 2


def test_what_a_patch_that_sticks_gives_less() -> None:
    """One height of the table, all radii and Poisson's ratios."""
    j = 3
    shape = shape_at(0.0, lt.nodes(*lt.heights(0.0), COUNTS["height"])[j])
    np.testing.assert_allclose(gains(shape, NUS), lt.table().punch[j], rtol=2e-5, atol=2e-6)


def errors(shape: Shape, nu: float, layers: tuple[Flat, ...] = ()) -> list[float]:
    """The largest relative differences between a tip's own sheets and those of the table: within the rim, head on."""
    k = shape.curvature
    own = own_tip(OwnTip(shape.height, k, nu, layers, None))
    table, radius = lt.of_tip(shape.height, k, nu), np.linspace(0.06, 0.4, 8)
    apart = []
    for place in np.array([0.1, 0.5, 0.9]) * lt.farthest(k):
        a = radius[radius <= lt.edge(k, place)]
        mine, read = (lt.compliance(tip, float(place), a) for tip in (own, table))
        direct = np.diagonal(mine, axis1=1, axis2=2)
        apart.append(float(np.max(np.abs(read - mine) / np.sqrt(direct[:, :, None] * direct[:, None, :]), initial=0.0)))
    head = [lt.head_on(tip, radius, 2.24) for tip in (own, table)]
    return [max(apart), float(np.max(np.abs(head[1] / head[0] - 1)))]


@pytest.mark.heavy
def test_ten_random_tips_and_one_with_a_pad_of_leather() -> None:
    """Their own sheets against the table, to what studies/beam/leather_elasticity.md claims of it; one has a pad of
    the same leather, which is no layer at all."""
    rng, apart = np.random.default_rng(24), []
    for i in range(10):
        k, nu = rng.uniform(0.5, 2.0), rng.uniform(0.2, 0.45)
        height = rng.uniform(max(lt.HEIGHT[0], lt.sag(k) + 0.05), 1.2)
        apart.append(errors(Shape(height, k), nu, ((0.04, 1.0, nu),) if i == 0 else ()))
    print("median, 95 %, largest of patches and head on:", np.quantile(apart, (0.5, 0.95, 1.0), axis=0).T.round(5))
    assert np.all(np.max(apart, axis=0) < LARGEST)
    assert np.all(np.quantile(apart, 0.95, axis=0) < 0.005)
