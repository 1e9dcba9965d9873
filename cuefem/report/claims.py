"""Claims of the sources: record and table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict

from rich.table import Table

from cuefem.report.record import Record
from cuefem.report.table import table_of
from cuefem.results.quantities import NONE
from cuefem.validation import NOISE, Claim, number


def claims_record(claims: Sequence[tuple[str, Claim]]) -> list[Record]:
    """Claims of sources, each with the study that holds it and its relative difference."""
    return [{"study": study, **asdict(claim), "difference": claim.difference} for study, claim in claims]


VERDICT_WORDS = (
    "agrees: ours rounds to the printed digits (formulas: the same to 1e-8; a statement without a number, printed –, "
    "holds; a number that depends on something the source leaves open lies in the possible range, see its cause); "
    "rounding: the source's own digits or stated approximation explain the difference; slip: a slip in the paper; "
    "not derivable: the source gives too little to derive it"
)


def claims_table(record: Sequence[Record]) -> Table:
    """Claims of sources beside what follows from their equations."""
    columns = ["source: what, unit", "verdict", "printed", "ours", "difference"]
    table = table_of("Claims of the sources, checked", columns, text_columns=2)
    for claim in record:
        gap = claim["difference"]
        shown = NONE if gap is None else f"< {NOISE:g}" if abs(gap) < NOISE else f"{gap:.2g}"
        unit = f", {claim['unit']}" if claim["unit"] else ""
        numbers = (number(claim["printed"], 6), number(claim["derived"], 6), shown)
        table.add_row(f"{claim['source']}: {claim['what']}{unit}", claim["verdict"], *numbers)
    return table
