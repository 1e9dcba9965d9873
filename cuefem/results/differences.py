"""Differences of two cues' results, each with the uncertainty that does not cancel and whether the two are distinct."""

from __future__ import annotations

import math
from collections.abc import Container, Mapping
from typing import Protocol

from cuefem.parameters.table import PARAMETERS
from cuefem.quantity.display_units import format_change
from cuefem.results.records import Record
from cuefem.results.uncertainty import RATIO_FLOOR, difference_record, model_share
from cuefem.scene import Scene

# Relative, of shape, weights and frequencies: 0.2 g of 100 g, 0.01 mm of 13 mm to the fourth power; of ball speed and
# energy of vibration the numerical error.
SHAPE_FLOOR = 2e-3


class Compared(Protocol):
    """A scene, its results in SI by name, and their relative changes by uncertain input."""

    @property
    def scene(self) -> Scene:
        """The scene."""

    @property
    def numbers(self) -> Mapping[str, float]:
        """Its results, nan for one that it does not have."""

    @property
    def inputs(self) -> Mapping[str, Mapping[str, float]]:
        """Relative changes of the results with each uncertain input, as of `changes_by_input`."""


def relative_differences(
    first: Compared, other: Compared, *, same_shaft: bool, with_model_error: Container[str]
) -> dict[str, Record]:
    """Relative differences of the other's results, by name: "difference", "error" (1 sigma) and "distinct".

    An error that both share cancels: that of a tip of the same value on both, and of the wood if they are one shaft
    before and after a change (same_shaft). with_model_error: the results to which the model adds its part of the
    logarithm (`model_share`), and `RATIO_FLOOR`; others have `SHAPE_FLOOR`. A result that one of them lacks, that is 0,
    or that has another sign has no relative difference.
    """
    records: dict[str, Record] = {}
    for name, value in first.numbers.items():
        ratio = other.numbers[name] / value if value else math.nan
        if not ratio > 0:
            continue
        inputs = {**first.inputs, **other.inputs}
        errors = [_input_error(first, other, key, name, same_shaft=same_shaft) for key in inputs]
        share, floor = 0.0, SHAPE_FLOOR
        if name in with_model_error:
            share, floor = model_share(first.scene, other.scene), RATIO_FLOOR
        difference = difference_record(ratio, share, *errors, floor=floor)
        if not math.isnan(difference["error"]):  # a strike at a limit of an input's range is a miscue
            records[name] = difference
    return records


def _input_error(first: Compared, other: Compared, key: str, name: str, *, same_shaft: bool) -> float:
    """Uncertainty of the logarithm of a ratio of two cues' results by one input."""
    changes = [each.inputs.get(key, {}).get(name, 0.0) for each in (first, other)]
    shared = is_shared(key, first.scene, other.scene, same_shaft=same_shaft)
    return abs(changes[1] - changes[0]) if shared else math.hypot(*changes)


def is_shared(key: str, first: Scene, other: Scene, *, same_shaft: bool) -> bool:
    """Whether two scenes have one error of an input: one value of a tip or butt, or one shaft."""
    parameter = PARAMETERS[key]
    return parameter.value(first) == parameter.value(other) if parameter.is_shareable else same_shaft


def difference_text(difference: float, error: float) -> str:
    """A relative difference with its uncertainty: "−3.2 ± 8.1 %"."""
    digits = 0 if error >= 0.1 else 1 if error >= 0.002 else 2
    return format_change(100 * difference, digits, f"± {100 * error:.{digits}f} %")
