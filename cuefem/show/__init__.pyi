"""Output of the commands: records of SI numbers for programs, and tables of them for people."""

from .effects_table import DEFAULT_RTOL, effects_record, tabulate_effects
from .end_mass_table import end_mass_record, tabulate_end_masses
from .report_sections import report_record, tabulate_report
from .model_error_table import model_error_record, tabulate_model_error
from .modes_table import modes_record, tabulate_modes
from .scene_summary import cue_record
from .squirt_table import squirt_record, tabulate_squirt
from .strike_table import strike_record, tabulate_strike

__all__ = [
    "DEFAULT_RTOL",
    "cue_record",
    "effects_record",
    "end_mass_record",
    "model_error_record",
    "modes_record",
    "report_record",
    "squirt_record",
    "strike_record",
    "tabulate_effects",
    "tabulate_end_masses",
    "tabulate_model_error",
    "tabulate_modes",
    "tabulate_report",
    "tabulate_squirt",
    "tabulate_strike",
]
