from . import plot as plot
from .analysis.reduction import reduction as reduction
from .beam.mesh import Resolution as Resolution
from .beam.modes import modes as modes
from .contact.motion_history import motion as motion
from .contact.table_frame import BallMotion as BallMotion, place as place
from .contact.side_strike import (
    SideOutcome as SideOutcome,
    SideStrike as SideStrike,
    Striker as Striker,
    side_strike as side_strike,
)
from .contact.strike import batch_strike as batch_strike, strike as strike
from .contact.tip_identification import identify_tip as identify_tip
from .contact.tip_identification import rebound as rebound
from .cue.materials import material as material
from .cue.geometry import Cue as Cue, LumpedCue as LumpedCue, Material as Material, Segment as Segment
from .analysis.comparison import compare as compare
from .analysis.contact_history import contact_history as contact_history
from .analysis.convergence_study import convergence_study as convergence_study
from .analysis.cue_numbers import cue_numbers as cue_numbers
from .analysis.design_changes import design_changes as design_changes
from .analysis.effect_sensitivity import effect_sensitivity as effect_sensitivity
from .analysis.end_mass import end_masses as end_masses
from .analysis.measured import estimate as estimate
from .analysis.model_error import model_error as model_error
from .analysis.natural_frequencies import natural_frequencies as natural_frequencies
from .analysis.page_notes import accuracy as accuracy, definitions as definitions, segments as segments
from .analysis.parts import parts as parts
from .analysis.cue_report import report as report
from .analysis.simulator_export import pooltool_export as pooltool_export
from .analysis.squirt_curve import squirt_curve as squirt_curve
from .analysis.strike_models import strike_models as strike_models
from .analysis.strike_table import strike_table as strike_table
from .analysis.tip_impacts import tip_impacts as tip_impacts
from .analysis.verdict import verdict as verdict
from .effects.cue_effects import (
    AxialWaves as AxialWaves,
    GeometricStiffness as GeometricStiffness,
    Joint as Joint,
    PointMass as PointMass,
    StructuralDamping as StructuralDamping,
    Support as Support,
)
from .effects.effect import Effect as Effect
from .effects.stroke_effects import Elevation as Elevation, SecondHit as SecondHit
from .effects.leather_tip import LeatherTip as LeatherTip, TipLayer as TipLayer
from .effects.tip_effects import (
    PowerLawTip as PowerLawTip,
    RollingContact as RollingContact,
    TipDome as TipDome,
    TipShear as TipShear,
)
from .measurements.calibration import Calibration as Calibration, load_calibration as load_calibration
from .endmass.definitions import end_mass as end_mass
from .endmass.lumped import impulse as impulse, lump as lump
from .scene.default_scene import usual_scene as usual_scene
from .files import load as load, save as save
from .files.paraview import save_motion as save_motion
from .designs.evaluation import Response as Response
from .designs.optimum import Limit as Limit, Problem as Problem
from .designs.sampling import Levels as Levels, Normal as Normal, Sample as Sample, Span as Span
from .designs.scatter import Scatter as Scatter
from .designs.study import Study as Study, Vary as Vary
from .designs.study_answer import study as study
from .files.errors import InputError as InputError
from .parameters.scene_changes import with_parameters as with_parameters
from .quantity.unit_checks import PlausibilityWarning as PlausibilityWarning
from .solid.solid_resolution import Solid as Solid
from .solid.shaft import SolidModes as SolidModes, solid_modes as solid_modes
from .scene.scene import (
    Ball as Ball,
    Outcome as Outcome,
    Scene as Scene,
    Stroke as Stroke,
    Tip as Tip,
)

__version__: str

__all__: list[str]
