"""What the commands show: records of plain SI numbers for programs, and readable tables made of them for people."""

from .claims import claims_record, claims_table
from .effects import DEFAULT_RTOL, effects_record, effects_table
from .end_mass import end_mass_record, end_mass_table
from .everything import numbers_table, report_record
from .materials import materials_record, materials_table
from .modes import modes_record, modes_table
from .record import cue_record
from .squirt import pivot_table, squirt_record, squirt_table
from .strike import strike_record, strike_table

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
    "numbers_table",
    "pivot_table",
    "report_record",
    "squirt_record",
    "squirt_table",
    "strike_record",
    "strike_table",
]
