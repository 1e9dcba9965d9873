"""What the commands show: records of plain SI numbers for programs, and readable tables made of them for people."""

from cuefem.report.effects import DEFAULT_RTOL, effects_record, effects_table
from cuefem.report.records import (
    claims_record,
    cue_record,
    end_mass_record,
    materials_record,
    modes_record,
    report_record,
    squirt_record,
    strike_record,
)
from cuefem.report.tables import (
    claims_table,
    end_mass_table,
    materials_table,
    modes_table,
    pivot_table,
    squirt_table,
    strike_table,
)

__all__ = [
    "DEFAULT_RTOL",
    "claims_record",
    "claims_table",
    "cue_record",
    "effects_record",
    "effects_table",
    "end_mass_record",
    "end_mass_table",
    "materials_record",
    "materials_table",
    "modes_record",
    "modes_table",
    "pivot_table",
    "report_record",
    "squirt_record",
    "squirt_table",
    "strike_record",
    "strike_table",
]
