"""Claims of the sources: record and sheet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from cuefem.results.quantities import NONE
from cuefem.results.records import Entry, Record, Sheet, sheet
from cuefem.validation import NOISE, Claim, number


def claims_record(claims: Sequence[tuple[str, Claim]]) -> list[Record]:
    """Claims of sources, each with the study that holds it and its relative difference."""
    return [{"study": study, **asdict(claim), "difference": claim.difference} for study, claim in claims]


VERDICT_WORDS = (
    "agrees: ours rounds to the printed digits (formulas: the same to 1e-8; a statement without a number, printed –, "
    "holds); rounding: the source's own digits or stated approximation explain the difference; slip: a slip in the "
    "paper; not derivable: the source gives too little to derive it, as the 250 Hz of a shaft whose E it does not say"
)


def claims_sheet(record: Sequence[Record]) -> Sheet:
    """Claims of sources beside what follows from their equations."""
    columns: dict[str, Entry] = {
        "source: what, unit": lambda claim: f"{claim['source']}: {', '.join(filter(None, _what(claim)))}",
        "verdict": "{verdict}",
        "printed": lambda claim: number(claim["printed"], 6),
        "ours": lambda claim: number(claim["derived"], 6),
        "difference": lambda claim: _gap(claim["difference"]),
    }
    return sheet("Claims of the sources, checked", columns, record, texts=(0, 1))


def _what(claim: Mapping[str, Any]) -> tuple[str, str]:
    return claim["what"], claim["unit"]


def _gap(gap: float | None) -> str:
    return NONE if gap is None else f"< {NOISE:g}" if abs(gap) < NOISE else f"{gap:.2g}"
