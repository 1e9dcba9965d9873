"""The results that can be computed of a solved design: the registry's, and the end mass by every definition."""

from __future__ import annotations

import math

from cuefem.endmass.definitions import DEFINITIONS, Definition
from cuefem.quantity.display_units import END_MASS
from cuefem.results.quantities import RESULTS, Result
from cuefem.results.solved_design import SolvedDesign


def computable_results() -> dict[str, Result]:
    """All results of a design, by name: also "end_mass_NAME" for every definition of the end mass."""
    results = {name: result for name, result in RESULTS.items() if result.of is not None}
    return results | {f"end_mass_{name}": _defined(definition) for name, definition in DEFINITIONS.items()}


def _defined(definition: Definition) -> Result:
    return Result(
        f"end mass, {definition.label}",
        "kg",
        about=definition.meaning,
        of=lambda design, offset: design.end_mass(definition.name, offset),
        argument="offset" if definition.at_offset else "",
        better="lower",
        has_model_error=True,
        is_listed=False,
        displayed=END_MASS,
    )


def listed_results(design: SolvedDesign) -> dict[str, float | None]:
    """Every listed result of a design, None where it has none: what a report and the designer show by its name."""
    return {
        name: _value(result, design)
        for name, result in RESULTS.items()
        if result.of is not None and result.is_listed and (design.scene.cue.segments or not result.segments)
    }


def _value(result: Result, design: SolvedDesign) -> float | None:
    assert result.of is not None
    try:
        value = result.of(design, None)
    except (ValueError, RuntimeError):  # such as squirt of a miscue, stiffness of a clamped tip
        return None
    return value if math.isfinite(value) else None
