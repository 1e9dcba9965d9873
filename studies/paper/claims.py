"""A statement of a source, what follows from its equations, and the table of a study's page."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from studies.pages import NONE, number

# An error: the paper's own definitions give another value. A misprint: a wrong sign, symbol or factor in print whose
# right one the paper uses. A hypothesis: a guess of the paper, or of ours about what it means.
VERDICTS = ("agrees", "rounding", "misprint", "simplification", "hypothesis", "error", "open")
COLUMNS = ("source", "what", "printed", "derived", "unit", "relative difference", "verdict", "cause")
NOISE = 1e-9  # relative differences below it are rounding errors, the same on no two machines


@dataclass(frozen=True)
class Claim:
    """One statement of a source: its place, its subject, both values, and the cause of a difference.

    printed, derived: numbers in ``unit``, None if the source (or the derivation) gives no number. verdict: one of
    VERDICTS; "rounding" means that the source's own digits or its stated approximation explain the difference,
    "simplification" that its model leaves out what makes it, "open" that it gives too little to decide. cause: in a few
    words, empty if the two agree without a remark.
    """

    source: str
    what: str
    printed: float | None
    derived: float | None
    unit: str = ""
    verdict: str = "agrees"
    cause: str = ""

    def __post_init__(self) -> None:
        if self.verdict not in VERDICTS:
            raise ValueError(f"Claim.verdict must be one of {', '.join(VERDICTS)}; got {self.verdict!r}")
        for name in ("source", "what", "unit", "cause"):
            if set("|\n") & set(getattr(self, name)):
                raise ValueError(f"Claim.{name} must hold no | or line break; got {getattr(self, name)!r}")
        for name in ("printed", "derived"):
            value = getattr(self, name)
            if value is not None and not math.isfinite(value):
                raise ValueError(f"Claim.{name} must be finite or None; got {value}")

    @property
    def difference(self) -> float | None:
        """(printed - derived)/abs(derived); None without both numbers or with derived 0."""
        if self.printed is None or not self.derived:
            return None
        return (self.printed - self.derived) / abs(self.derived)


def gap(claim: Claim) -> str:
    """The relative difference of a claim as tables print it."""
    size = claim.difference
    return NONE if size is None else f"< {NOISE:g}" if abs(size) < NOISE else f"{size:.2g}"


def markdown_row(claim: Claim) -> str:
    """A claim as a row of a markdown table."""
    numbers = (number(claim.printed), number(claim.derived))
    cells = (claim.source, claim.what, *numbers, claim.unit, gap(claim), claim.verdict, claim.cause)
    return "| " + " | ".join(cells) + " |"


def markdown(claims: Sequence[Claim]) -> str:
    """Claims as a markdown table."""
    head = ["| " + " | ".join(COLUMNS) + " |", "|" + "---|" * len(COLUMNS)]
    return "\n".join([*head, *map(markdown_row, claims)]) + "\n"
