"""Responses of designs, and their evaluation for many designs, each of which may fail on its own."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from cuefem.beam.modes import Modes
from cuefem.cue import Array
from cuefem.quantity.display import counted, one_line
from cuefem.quantity.display_units import with_heading
from cuefem.quantity.equality import equal_fields
from cuefem.quantity.fields import suggestion
from cuefem.quantity.unit_checks import FLOAT_ERRORS
from cuefem.results.computable_results import computable_results
from cuefem.results.quantities import Result
from cuefem.results.solved_design import SolvedDesign
from cuefem.scene import Resolution, Scene
from cuefem.scene.solved_scene import SolvedScene

# A design may fail because it is invalid, has no response, or its numbers overflow.
Failed = (ValueError, RuntimeError, ArithmeticError)
_NAME = re.compile(r"(\w+)(?:\(\s*([^()\s]+)\s*\))?")


@dataclass(frozen=True)
class Response:
    """One number computed for every design of a study.

    Parameters
    ----------
    kind : str
        The name of a result, such as "squirt" (`cuefem guide study` lists them).
    argument : float or int, optional
        Of a strike the offset b/R, by default the scene's own; of a frequency the number of the mode. "pivot_length"
        and "end_mass" without one are the limits of small offsets.

    Raises
    ------
    ValueError
        If there is no such result, or the argument is none of its own.

    Examples
    --------
    >>> import cuefem as cf
    >>> cf.Response.of("squirt(0.3)") == cf.Response("squirt", 0.3), cf.Response("frequency", 2).label
    (True, 'natural frequency 2')
    """

    kind: str
    argument: float | int | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "argument", _checked(self.kind, self.argument, self.name))

    @classmethod
    def of(cls, text: str) -> Response:
        """Read text such as "squirt(0.3)"; ValueError, suggesting similar names, if no response matches."""
        match = _NAME.fullmatch(text.strip())
        if not match:
            raise _unknown(text)
        kind, argument = match.groups()
        return cls(kind, _checked(kind, None if argument is None else _number(argument), text))

    @property
    def result(self) -> Result:
        """The declaration of the result."""
        return computable_results()[self.kind]

    @property
    def name(self) -> str:
        """The response as text, the inverse of `of`."""
        return self.kind if self.argument is None else f"{self.kind}({self.argument!r})"

    @property
    def label(self) -> str:
        """The response in tables and on pages: "squirt at b/R 0.3", "natural frequency 2"."""
        kind = self.result
        if self.argument is not None:
            return f"{kind.column_heading} {'' if kind.argument == 'mode' else 'at b/R '}{self.argument}"
        return (
            f"{kind.column_heading} at the stroke's offset" if kind.argument and not kind.limit else kind.column_heading
        )

    @property
    def unit(self) -> str:
        """SI unit, "" for a pure number."""
        return self.result.unit

    @property
    def display_key(self) -> str:
        """The key of its display unit."""
        return self.result.display_key

    @property
    def heading(self) -> str:
        """The label with its display unit."""
        return with_heading(self.label, self.display_key)

    def size(self, values: Any) -> Any:
        """Values (numbers or arrays) as designs are compared: squirt, negative at a left-hand offset, by its size."""
        return abs(values) if self.result.odd else values

    def loss(self, values: Any) -> Any:
        """Values of which the lowest is best."""
        return -self.size(values) if self.result.better == "higher" else self.size(values)

    def value(self, design: SolvedDesign) -> float:
        """The response of a design; ValueError if it has none."""
        if self.result.segments and not design.scene.cue.segments:
            raise ValueError(f"{self.name} needs a cue of segments; got a lumped cue")
        assert self.result.of is not None
        value = self.result.of(design, self.argument)
        if not math.isfinite(value):
            raise ValueError(f"{self.name} is not a finite number")
        return value


def _usage(kind: str) -> str:
    argument = computable_results()[kind].argument
    return f"{kind}({argument})" if argument == "mode" else f"{kind}[({argument})]" if argument else kind


def _unknown(text: str) -> ValueError:
    """The error for a text that is no response, with a similar name."""
    hint = suggestion(text.partition("(")[0], computable_results())
    return ValueError(f"must be one of {', '.join(map(_usage, computable_results()))}; got {text!r}{hint}")


def _number(argument: str | float) -> float:
    """The number of an argument, nan if it is none."""
    try:
        return float(argument)
    except (TypeError, ValueError):
        return math.nan


def _checked(kind: str, argument: float | None, text: str) -> float | int | None:
    """The argument of a response, the number of a mode as an integer; ValueError, with the text, for another one."""
    if kind not in computable_results():
        raise _unknown(text)
    expected = computable_results()[kind].argument
    if argument is None and expected != "mode":
        return None
    if expected == "":
        raise ValueError(f"must be {kind}, without brackets; got {text!r}")
    number = math.nan if argument is None else _number(argument)
    if expected == "mode":
        if not (number >= 1 and number.is_integer()):
            raise ValueError(f"must be {kind}(n), n a whole number >= 1; got {text!r}")
        return int(number)
    if not -1 < number < 1 or (number == 0 and kind == "pivot_length"):
        without = " without 0" if kind == "pivot_length" else ""
        raise ValueError(f"must be {kind}(b), b an offset b/R in (-1, 1){without}; got {text!r}")
    return number


@dataclass(frozen=True, eq=False)
class Evaluation:
    """Responses of designs: values (designs, responses) in SI units, nan if a response has no value; reasons, the first
    reason for a missing value of a design, None if it has all.
    """

    values: Array
    reasons: tuple[str | None, ...]

    __eq__ = equal_fields


@np.errstate(**FLOAT_ERRORS)
def evaluate(
    scenes: Sequence[Scene],
    responses: Sequence[Response | str],
    *,
    at: Resolution | None = None,
    squirt_factor: float = 1.0,
) -> Evaluation:
    """The responses of every scene, each as the call for one scene computes it.

    at: one resolution for all scenes; by default each has its own, that of `cuefem.strike` and `cuefem.end_mass`.
    squirt_factor: of a calibration, as of a `SolvedDesign`. The
    modes of a scene are solved once for all responses, and once for consecutive scenes with equal cue and effects on
    it. A failed response does not affect the others. ValueError for an unknown name.
    """
    parsed = [Response.of(response) if isinstance(response, str) else response for response in responses]
    values, reasons = np.full((len(scenes), len(parsed)), np.nan), list[str | None]([None] * len(scenes))
    previous: tuple[Any, ...] | None = None
    solved: dict[tuple[Resolution | int, int | None, int], Modes] = {}
    for i, scene in enumerate(scenes):
        on_cue = scene.cue, scene.cue_effects
        previous, solved = on_cue, solved if on_cue == previous else {}
        design = SolvedDesign(SolvedScene(scene, at, solved), squirt_factor=squirt_factor)
        for j, response in enumerate(parsed):
            try:
                values[i, j] = response.value(design)
            except Failed as error:
                reasons[i] = reasons[i] or one_line(str(error))
    return Evaluation(values, tuple(reasons))


def shortfalls(responses: Sequence[Response], values: Array) -> list[tuple[str, int | None]]:
    """What designs lack, such as "3 of 8 designs lack squirt(0.75)", each with the first design whose reason is of it.

    values: (designs, responses), nan where one is missing. Responses that the same designs lack are named together.
    """
    missing = np.isnan(values)
    together: dict[bytes, list[int]] = {}
    for k in np.flatnonzero(missing.any(axis=0)).tolist():
        together.setdefault(missing[:, k].tobytes(), []).append(k)
    lines = list[tuple[str, int | None]]()
    for lacked in together.values():
        designs = np.flatnonzero(missing[:, lacked[0]])
        names = ", ".join(responses[k].name for k in lacked)
        verb = "lacks" if len(designs) == 1 else "lack"
        what = "failed" if len(lacked) == len(responses) else f"{verb} {names}"
        explained = designs[missing[designs].argmax(axis=1) == lacked[0]]  # a design's reason is that of its first
        first = int(explained[0]) if len(explained) else None
        lines.append((f"{len(designs)} of {counted(len(values), 'design')} {what}", first))
    return lines
