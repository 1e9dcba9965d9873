"""What a maker can change, for people."""

from __future__ import annotations

from dataclasses import replace

from cuefem.report.strike_table import grip_warning
from cuefem.results.quantities import signed, with_unit
from cuefem.results.records import Record, Sheet, sheet

STYLES = {"worthwhile": "bold", "more squirt": "dim", "within uncertainty": "dim"}


def advice_sheet(record: Record) -> Sheet:
    """A row for each change, the least squirt first."""
    rows = record["changes"]
    made = sheet(
        "Design changes",
        {
            "change": "{change}",
            "squirt": lambda row: signed(100 * row["squirt_change"], 1, f"± {100 * row['squirt_change_error']:.1f} %"),
            "stiffness": lambda row: _percent(row["tip_stiffness_change"]),
            "weight": lambda row: signed(1e3 * row["shaft_mass_change"], 1, "g"),
            "first tone": lambda row: signed(row["frequency_change"], 1, "Hz"),
            "recommendation": "{verdict}",
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
        f"{with_unit(record['own']['squirt'], 'rad', decimals=2)}. ±: 1σ, of the model, of the wood and tip that "
        "nobody measured, and 1 %. Worthwhile: less squirt by more than that; within uncertainty: nobody knows.",
        "Stiffness: static, at the tip, the butt end clamped. Costs stiffness: 5 % of it or more.",
    ]


def _percent(share: float) -> str:
    return signed(100 * share, 1 if abs(share) < 0.095 else 0, "%")
