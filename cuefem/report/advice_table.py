"""What a maker can change, for people."""

from __future__ import annotations

from dataclasses import replace

from cuefem.report.strike_table import grip_warning
from cuefem.results.band import OF_DIFFERENCE
from cuefem.results.quantities import signed, with_unit
from cuefem.results.records import Record, Sheet, sheet

STYLES = {"pays": "bold", "more squirt": "dim"}


def advice_sheet(record: Record) -> Sheet:
    """A row for each change, the least squirt first."""
    rows = record["changes"]
    made = sheet(
        "What would change it",
        {
            "change": "{change}",
            "squirt": lambda row: _percent(row["squirt_change"]),
            "stiffness": lambda row: _percent(row["tip_stiffness_change"]),
            "weight": lambda row: signed(1e3 * row["shaft_mass_change"], 1, "g"),
            "first tone": lambda row: signed(row["frequency_change"], 1, "Hz"),
            "worth it?": "{verdict}",
        },
        rows,
        *advice_notes(record),
        texts=(0, 5),
    )
    styles = {i: STYLES[row["verdict"]] for i, row in enumerate(rows) if row["verdict"] in STYLES}
    return replace(made, styles=styles)


def advice_notes(record: Record) -> list[str]:
    """What the table is."""
    warning = grip_warning(record["grip"])
    return [
        *([warning] if warning else []),
        f"Each change alone, by the whole stroke at b/R {record['offset']:.4g}, where this cue has "
        f"{with_unit(record['own']['squirt'], 'rad', decimals=2)} (a report says how far that may be off); a change of "
        f"squirt was right to {100 * OF_DIFFERENCE:.0f} % of itself on measured cues.",
        "Stiffness: static, at the tip, the butt end clamped. Pays: a hundredth less squirt or more; costs stiffness: "
        "a twentieth of it or more.",
    ]


def _percent(share: float) -> str:
    return signed(100 * share, 1 if abs(share) < 0.095 else 0, "%")
