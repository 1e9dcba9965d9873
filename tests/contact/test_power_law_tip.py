"""A tip with a power law against its closed form."""

import pytest

import cuefem as cf
from tests.helpers.orders import falls_with_the_step


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.0, 3.7])
@pytest.mark.parametrize(("speed", "e"), [(0.2, 0.4), (1.0, 0.1), (7.0, 1.0)])
def test_head_on_contact_time_falls_with_speed(exponent, speed, e):
    scene = cf.Scene(
        cf.LumpedCue(0.5, 0.005),
        tip=cf.Tip(e, contact_time=1.3e-3),
        stroke=cf.Stroke(speed),
        effects=(cf.PowerLawTip(exponent, speed=2.0),),
    )
    time = 1.3e-3 * (speed / 2.0) ** ((1 - exponent) / (1 + exponent))
    Q0 = 0.5 / 0.210

    def error(steps: int) -> float:
        outcome = cf.strike(scene, cf.Resolution(1, 1, 1, steps))
        leaves = outcome.ball_speed / (speed * (1 + e) * Q0 / (1 + Q0))
        return max(abs(outcome.duration / time - 1), abs(leaves - 1))

    falls_with_the_step(error)
