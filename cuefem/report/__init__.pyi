"""Output of the commands: records of SI numbers for programs, and tables of them for people."""

from .effects import DEFAULT_RTOL, effects_record, effects_sheet
from .end_mass import end_mass_record, end_mass_sheet
from .everything import report_record, report_sheets
from .model_error import model_error_record, model_error_sheet
from .modes_table import modes_record, modes_sheet
from .scene_words import cue_record
from .squirt import squirt_record, squirt_sheet
from .strike_table import strike_record, strike_sheet

__all__ = [
    "DEFAULT_RTOL",
    "cue_record",
    "effects_record",
    "effects_sheet",
    "end_mass_record",
    "end_mass_sheet",
    "model_error_record",
    "model_error_sheet",
    "modes_record",
    "modes_sheet",
    "report_record",
    "report_sheets",
    "squirt_record",
    "squirt_sheet",
    "strike_record",
    "strike_sheet",
]
