"""Output of the commands: records of SI numbers for programs, and tables of them for people."""

from .effects_table import DEFAULT_RTOL, effects_record, tabulate_effects
from .model_error_table import model_error_record, tabulate_model_error

from .scene_summary import cue_record

__all__ = [
    "DEFAULT_RTOL",
    "cue_record",
    "effects_record",
    "model_error_record",
    "tabulate_effects",
    "tabulate_model_error",
]
