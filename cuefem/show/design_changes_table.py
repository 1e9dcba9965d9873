"""Design changes that a maker can make: table of `cuefem improve`."""

from __future__ import annotations

from dataclasses import replace

from cuefem.results.quantities import format_change, with_unit
from cuefem.results.records import Record, Table, tabulate
from cuefem.show.strike_table import regime_warning

STYLES = {"worthwhile": "bold", "more squirt": "dim", "within uncertainty": "dim"}


def tabulate_design_changes(record: Record) -> Table:
    """A row for each design change, the lowest squirt first."""
    rows = record["changes"]
    table = tabulate(
        "Design changes",
        {
            "change": "{change}",
            "squirt change": lambda row: format_change(
                100 * row["squirt_change"], 1, f"± {100 * row['squirt_change_error']:.1f} %"
            ),
            "stiffness change": lambda row: _percent(row["tip_stiffness_change"]),
            "mass change": lambda row: format_change(1e3 * row["shaft_mass_change"], 1, "g"),
            "natural frequency change": lambda row: format_change(row["frequency_change"], 1, "Hz"),
            "recommendation": "{verdict}",
        },
        rows,
        *design_change_notes(record),
        texts=(0, 5),
    )
    styles = {i: STYLES[row["verdict"]] for i, row in enumerate(rows) if row["verdict"] in STYLES}
    return replace(table, styles=styles)


def design_change_notes(record: Record) -> list[str]:
    """Definitions of the table's columns."""
    warning = regime_warning(record["regime"])
    return [
        *([warning] if warning else []),
        f"Each change on its own, by the coupled strike at b/R {record['offset']:.4g}; this cue: "
        f"{with_unit(record['unmodified']['squirt'], 'rad', decimals=2)}. ±: uncertainty of the change (1σ): model, "
        "unmeasured wood and tip, and 1 %. Worthwhile: squirt falls by more than its uncertainty; within uncertainty: "
        "the change is smaller than its uncertainty.",
        "Stiffness: static, at the tip, joint end clamped. Costs stiffness: by 5 % or more. Natural frequency: of the "
        "first mode.",
    ]


def _percent(share: float) -> str:
    return format_change(100 * share, 1 if abs(share) < 0.095 else 0, "%")
