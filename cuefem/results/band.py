"""How sure a squirt is: the errors of the model, of what was assumed, and of the computation, added in quadrature."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import NamedTuple

from cuefem.contact.strike import strike_modes
from cuefem.parameters.parameter import PLACES, Place, replaced
from cuefem.scene import Scene
from cuefem.tip_modes import Solved

# Of the model, from the folders of studies/measured with nothing fitted (tests/results/test_band.py makes them again).
# Level: measured over computed squirt, less 1, root mean square of seven strokes of three cues, for a tip of leather
# and for a spring without a dome.
LEVEL, LEVEL_OF_SPRING = 0.15, 0.28
# Of two shafts' squirt: the error of the logarithm of their ratio as a part of that logarithm, of one measured pair of
# shafts and of 31 places of two masses on a shaft. Nothing that two shafts share adds to it.
OF_DIFFERENCE = 0.53
COMPUTED = 0.002  # of squirt at the default resolution: 0.19 % at most (studies/accuracy/accuracy.md)


class Band(NamedTuple):
    """Relative errors of a squirt, one standard deviation each.

    model: what real cues differed by. inputs: what wood and tip that nobody measured may be off. computation: of modes
    and steps.
    """

    model: float
    inputs: float
    computation: float

    @property
    def whole(self) -> float:
        """All of them in quadrature."""
        return math.hypot(*self)


def band(scene: Scene, inputs: Mapping[str, float], error: float | None = None) -> Band:
    """The band of a scene's squirt. inputs: see `of_inputs`. error: of the computation, if it is known better."""
    level = LEVEL if scene.contact_terms.tip is not None else LEVEL_OF_SPRING
    return Band(level, math.hypot(*inputs.values()), COMPUTED if error is None else error)


def of_shaft(inputs: Mapping[str, float]) -> float:
    """What the inputs of the shaft alone may be off: what is left where two shafts are struck with one tip."""
    return math.hypot(*(share for key, share in inputs.items() if not of_tip(PLACES[key])))


def of_tip(known: Place) -> bool:
    """Whether a place is the tip's, which two shafts may share."""
    return known.group == "Tip" or known.path.startswith("leather.")


def of_inputs(solved: Solved, own: float) -> dict[str, float]:
    """By how much squirt changes, relatively, with each place of a scene that may be off by its usual spread.

    own: its squirt, rad.
    """
    if not own:
        return {}
    changes = changes_by_input(solved.scene, {"squirt": own}, lambda made: {"squirt": squirt_beside(solved, made)})
    return {key: abs(change["squirt"]) for key, change in changes.items()}


def changes_by_input(
    scene: Scene, own: Mapping[str, float], of: Callable[[Scene], Mapping[str, float]]
) -> dict[str, dict[str, float]]:
    """The relative changes of some numbers of a scene with each place that may be off by its usual spread.

    own: the numbers of the scene. of: those of a changed one. Signs are those of a larger value at the place.
    """
    changes: dict[str, dict[str, float]] = {}
    for key, known in PLACES.items() if scene.cue.segments else ():
        spread = known.spread(scene) if callable(known.spread) else known.spread
        ways = (spread, -spread) if spread is not None else (math.log1p(-known.below),) if known.below else ()
        value = known.value(scene) if ways else None
        if not value:
            continue
        for off in ways:  # the other way where no cue can be farther out
            try:
                made = of(replaced(scene, {known.steps(): value * math.exp(off)}))
            except (ValueError, RuntimeError):
                continue
            changes[key] = {name: math.copysign(1.0, off) * (made[name] / own[name] - 1) for name in own}
            break
    return changes


def squirt_beside(solved: Solved, made: Scene) -> float:
    """Squirt of a changed scene, rad, by the modes that are known where the cue is not changed."""
    if (made.cue, made.cue_effects) == (solved.scene.cue, solved.scene.cue_effects):
        return float(strike_modes(made, solved.tip).squirt)
    return squirt_of(made)


@lru_cache(maxsize=64)
def squirt_of(scene: Scene) -> float:
    """Squirt of a scene's coupled strike, rad, remembered for what is asked again and again, such as a ready cue."""
    return float(strike_modes(scene, Solved(scene).tip).squirt)


def of_difference(mine: float, other: float, inputs: float = 0.0) -> float:
    """The error of the ratio of two shafts' squirt. inputs: relative, of what the shafts do not share (`of_shaft`)."""
    ratio = mine / other
    return ratio * math.hypot(OF_DIFFERENCE * math.log(ratio), inputs)
