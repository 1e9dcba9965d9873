"""Contact state of strokes with and without a leather tip, and of phases and losses (properties)."""

from dataclasses import replace
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.analysis.strike_models import regime_warning
from cuefem.contact.outcome import Phase, contact_state

MAPLE = cf.load(Path(__file__).parents[2] / "meshes" / "pool_maple.toml")
assert isinstance(MAPLE, cf.Cue)
LEATHER = cf.usual_scene(MAPLE)


@pytest.mark.parametrize(
    ("speed", "offset", "regime"),
    [(7, 0.4, "stick"), (7, 0.45, "partial slip"), (4, 0.45, "stick"), (4, 0.5, "partial slip"), (2, 0.5, "stick")],
)
def test_regime_with_long_partial_slip_warns(speed: float, offset: float, regime: str) -> None:
    """Squirt over b/R is more than 20 % above that near the centre where friction dissipates much energy."""
    outcome, close = (cf.strike(replace(LEATHER, stroke=cf.Stroke(speed, b))) for b in (offset, 0.2))
    assert outcome.regime == regime
    assert bool(regime_warning(regime)) == (regime != "stick") == (outcome.squirt / offset > 1.2 * close.squirt / 0.2)


@pytest.mark.parametrize(
    ("offset", "regime"), [(0.0, "stick"), (0.45, "stick"), (0.575, "gross slip"), (0.6, "miscue")]
)
def test_spring_tip_slips_beyond_the_friction_cone(offset: float, regime: str) -> None:
    """The cone of a friction of 0.7 ends at b/R 0.573."""
    scene = cf.Scene(MAPLE, LEATHER.ball, cf.Tip(0.73, 0.7, 1.1e-3), cf.Stroke(2.0, offset))
    assert cf.strike(scene).regime == regime


# Phases with their shares of the normal impulse in %; friction loss in % of the ball's energy; state.
STATES = """
stick load 50, stick unload 50                                       | 4.9 | stick
stick load 50, stick unload 50                                       | 5.1 | partial slip
slip load 24, stick load 26, stick unload 50                         | 4.9 | stick
slip load 26, stick load 24, stick unload 50                         | 4.9 | gross slip
slip load 49, stick load 1, stick unload 50                          | 5.1 | gross slip
slip load 51, stick load 1, stick unload 48                          | 0   | miscue
slip load 10, slip unload 10, stick unload 80                        | 5.1 | late stick
slip load 9, slip back load 1, stick unload 90                       | 5.1 | slip reversal
stick load 50, stick unload 18, slip unload 32                       | 0   | gross slip
stick load 50, stick unload 16, slip unload 34                       | 0   | miscue
stick load 50, stick unload 16, slip unload 20, slip back unload 14  | 0   | miscue
stick load 30, slip unload 20, stick unload 36, slip back unload 14  | 0   | gross slip
slip load 50, slip unload 50                                         | 0   | miscue
"""


@pytest.mark.parametrize("scale", [0.1, 30.0])
@pytest.mark.parametrize("row", STATES.strip().splitlines())
def test_contact_state_follows_from_shares_of_impulse_and_loss(row: str, scale: float) -> None:
    pieces, loss, state = (part.strip() for part in row.split("|"))
    words = [piece.rsplit(maxsplit=2) for piece in pieces.split(", ")]
    phases = [
        Phase(name, normal, i, i + 1, (0.0, scale * float(share))) for i, (name, normal, share) in enumerate(words)
    ]
    energy = {"friction loss": float(loss), "ball translation": 90.0, "ball rotation": 10.0}
    assert contact_state(phases, energy) == state
