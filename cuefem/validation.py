"""A source's claim beside what follows from its equations, and the tables that validation studies commit."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

VERDICTS = ("agrees", "rounding", "slip", "not derivable")
COLUMNS = ("source", "what", "printed", "derived", "unit", "relative difference", "verdict", "cause")
NONE = "–"
DIGITS = 8
NOISE = 1e-9  # relative differences below it are rounding errors, the same on no two machines


@dataclass(frozen=True)
class Claim:
    """One statement of a source: where it stands, what it is about, its value there and ours, and why they differ.

    printed, derived: numbers in ``unit``, None if the source (or the derivation) gives no number. verdict: one of
    VERDICTS; "rounding" means that the source's own digits or its stated approximation explain the difference. cause:
    in a few words, empty if the two agree without a remark.
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


def number(value: float | None, digits: int = DIGITS) -> str:
    """A number as tables print it."""
    return NONE if value is None else f"{value:.{digits}g}"


def markdown_row(claim: Claim) -> str:
    """A claim as a row of a markdown table."""
    gap = claim.difference
    shown = NONE if gap is None else f"< {NOISE:g}" if abs(gap) < NOISE else f"{gap:.2g}"
    numbers = (number(claim.printed), number(claim.derived))
    cells = (claim.source, claim.what, *numbers, claim.unit, shown, claim.verdict, claim.cause)
    return "| " + " | ".join(cells) + " |"


def markdown(claims: Sequence[Claim]) -> str:
    """Claims as a markdown table."""
    head = ["| " + " | ".join(COLUMNS) + " |", "|" + "---|" * len(COLUMNS)]
    return "\n".join([*head, *map(markdown_row, claims)]) + "\n"


def read_markdown(text: str) -> list[Claim]:
    """The claims of a table that `markdown` wrote, other lines passed over; numbers at their printed precision."""
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in text.splitlines() if line.startswith("|")]
    claims = []
    for cells in rows:
        if len(cells) == len(COLUMNS) and cells[6] in VERDICTS:
            source, what, printed, derived, unit, _, verdict, cause = cells
            claims.append(Claim(source, what, _value(printed), _value(derived), unit, verdict, cause))
    return claims


def _value(cell: str) -> float | None:
    return None if cell == NONE else float(cell)


_NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d*)?(?:e[+-]?\d+)?(?![\w.]*\w)")


def disagreements(committed: str, derived: str) -> list[str]:
    """Where two tables differ: text that is not the same, numbers apart by more than one in the last printed place.

    Lists the pairs of lines, empty where the tables agree. Numbers as in "4.1e-05" count by their last digit.
    """
    ours, theirs = committed.splitlines(), derived.splitlines()
    if len(ours) != len(theirs):
        return [f"{len(ours)} lines committed, {len(theirs)} derived"]
    return [f"{a}\n{b}" for a, b in zip(ours, theirs, strict=True) if not _same(a, b)]


def _same(ours: str, theirs: str) -> bool:
    if _NUMBER.sub("#", ours) != _NUMBER.sub("#", theirs):
        return False
    pairs = zip(_NUMBER.findall(ours), _NUMBER.findall(theirs), strict=True)
    return all(abs(float(a) - float(b)) <= 1.01 * max(_last_place(a), _last_place(b)) for a, b in pairs if a != b)


def _last_place(text: str) -> float:
    digits, _, exponent = text.partition("e")
    decimals = len(digits.partition(".")[2])
    return 10.0 ** (int(exponent or 0) - decimals)
