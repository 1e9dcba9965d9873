"""What can be asked of solved designs: every result that is computed of them, and every definition of the end mass."""

from __future__ import annotations

import math

import numpy as np

from cuefem.cue import Array
from cuefem.endmass.definitions import DEFINITIONS, Definition
from cuefem.results.designs import Designs
from cuefem.results.quantities import RESULTS, Result


def asked() -> dict[str, Result]:
    """All results that can be asked of a design, by name: also "end_mass_NAME" for every definition of the end mass."""
    own = {name: result for name, result in RESULTS.items() if result.of is not None}
    return own | {f"end_mass_{name}": _defined(definition) for name, definition in DEFINITIONS.items()}


def _defined(definition: Definition) -> Result:
    def values(designs: Designs, offset: float | None) -> Array:
        return np.array([designs.end_mass(i, definition, offset) for i in range(len(designs.scenes))])

    return Result(
        f"end mass, {definition.label}",
        "kg",
        about=definition.meaning,
        of=values,
        argument="offset" if definition.at_offset else "",
        strikes=True,
        better="lower",
        listed=False,
    )


def listed(designs: Designs, *, at_once: bool = False) -> dict[str, float | None]:
    """Every listed result of one design, None where it has none: what a report and the designer show by its name.

    at_once: leave out those that take a solution of their own.
    """
    cue = designs.scenes[0].cue
    return {
        name: _value(result, designs)
        for name, result in RESULTS.items()
        if result.of is not None
        and result.listed
        and (cue.segments or not result.segments)
        and not (at_once and result.solves)
    }


def _value(result: Result, designs: Designs) -> float | None:
    assert result.of is not None
    try:
        value = float(result.of(designs, None)[0])
    except (ValueError, RuntimeError):  # such as the stiffness of a cue whose effects hold its tip
        return None
    return value if math.isfinite(value) else None
