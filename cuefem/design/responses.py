"""What can be asked of a design, by name: "end_mass", "frequency(2)", "squirt(0.3)"."""

from __future__ import annotations

import difflib
import re
from dataclasses import dataclass

from cuefem.cue import Array
from cuefem.results.quantities import Result, with_heading
from cuefem.results.solved_design import Designs, asked

_NAME = re.compile(r"(\w+)(?:\(\s*([^()\s]+)\s*\))?")


@dataclass(frozen=True)
class Response:
    """One number asked of every design: the name of a result, and the number of the mode or the offset b/R.

    Without an offset, a strike is at the scene's own; "pivot_length" and "end_mass" are then the limits of small
    offsets.
    """

    kind: str
    argument: float | int | None = None

    @classmethod
    def of(cls, text: str) -> Response:
        """Read text such as "squirt(0.3)"; ValueError, suggesting similar names, if no response matches."""
        match = _NAME.fullmatch(text.strip())
        if not match or match[1] not in asked():
            close = difflib.get_close_matches(text.partition("(")[0], asked(), n=3, cutoff=0.5)
            hint = f"; did you mean {' or '.join(close)}?" if close else ""
            raise ValueError(f"must be one of {', '.join(map(_usage, asked()))}; got {text!r}{hint}")
        return cls(match[1], _argument(match[1], match[2], text))

    @property
    def result(self) -> Result:
        """What is asked, as it is declared."""
        return asked()[self.kind]

    @property
    def name(self) -> str:
        """The response as text that `of` reads back."""
        return self.kind if self.argument is None else f"{self.kind}({self.argument!r})"

    @property
    def label(self) -> str:
        """What tables and pages call it: "squirt at b/R 0.3", "tone 2"."""
        kind = self.result
        if self.argument is None:
            return f"{kind.in_short} at the stroke's offset" if self.in_time else kind.in_short
        return f"{kind.in_short} {'' if kind.argument == 'mode' else 'at b/R '}{self.argument}"

    @property
    def unit(self) -> str:
        """SI unit, "" for a pure number."""
        return self.result.unit

    @property
    def heading(self) -> str:
        """The same with the unit that people read it in."""
        return with_heading(self.label, self.unit)

    @property
    def in_time(self) -> bool:
        """Whether it takes a strike in time, some milliseconds a design."""
        kind = self.result
        return kind.argument == "offset" and not (kind.limit and self.argument is None)

    @property
    def modes(self) -> int:
        """How many frequencies it takes."""
        return int(self.argument or 0) if self.kind == "frequency" else 0

    def values(self, designs: Designs) -> Array:
        """The response of every design, (designs,)."""
        assert self.result.of is not None
        return self.result.of(designs, self.argument)


def _usage(kind: str) -> str:
    argument = asked()[kind].argument
    return f"{kind}({argument})" if argument == "mode" else f"{kind}[({argument})]" if argument else kind


def _argument(kind: str, argument: str | None, text: str) -> float | int | None:
    wanted = asked()[kind].argument
    if argument is None and wanted != "mode":
        return None
    if wanted == "":
        raise ValueError(f"must be {kind}, which takes nothing in brackets; got {text!r}")
    try:
        number = float(argument or "nan")
    except ValueError:
        number = float("nan")
    if wanted == "mode":
        if not (number >= 1 and number.is_integer()):
            raise ValueError(f"must be {kind}(n), n a whole number >= 1; got {text!r}")
        return int(number)
    if not -1 < number < 1 or (number == 0 and kind == "pivot_length"):
        without = " without 0" if kind == "pivot_length" else ""
        raise ValueError(f"must be {kind}(b), b an offset b/R in (-1, 1){without}; got {text!r}")
    return number
