from . import plot as plot
from .analysis.reduction import Reduction as Reduction, reduction as reduction
from .beam.mesh import Resolution as Resolution
from .beam.modes import Modes as Modes, modes as modes
from .contact.motion_history import Motion as Motion, motion as motion
from .contact.table_frame import BallMotion as BallMotion, place as place
from .contact.outcome import History as History, Phase as Phase
from .contact.side_strike import (
    SideOutcome as SideOutcome,
    SideStrike as SideStrike,
    Striker as Striker,
    side_strike as side_strike,
)
from .contact.strike import batch_strike as batch_strike, strike as strike
from .contact.tip_identification import IdentifiedTip as IdentifiedTip, identify_tip as identify_tip, rebound as rebound
from .cue.materials import material as material
from .cue.geometry import Cue as Cue, LumpedCue as LumpedCue, Material as Material, Segment as Segment
from .analysis.comparison import Comparison as Comparison, compare as compare
from .analysis.contact_history import ContactHistory as ContactHistory, contact_history as contact_history
from .analysis.convergence_study import ConvergenceStudy as ConvergenceStudy, convergence_study as convergence_study
from .analysis.cue_numbers import CueNumbers as CueNumbers, cue_numbers as cue_numbers
from .analysis.design_changes import (
    ChangedDesign as ChangedDesign,
    DesignChanges as DesignChanges,
    design_changes as design_changes,
)
from .analysis.effect_sensitivity import (
    EffectSensitivity as EffectSensitivity,
    effect_sensitivity as effect_sensitivity,
)
from .analysis.end_mass import DefinedEndMass as DefinedEndMass, EndMasses as EndMasses, end_masses as end_masses
from .analysis.measured import (
    MeasuredComparison as MeasuredComparison,
    MeasuredEstimate as MeasuredEstimate,
    estimate as estimate,
)
from .analysis.model_error import ModelError as ModelError, model_error as model_error
from .analysis.natural_frequencies import (
    NaturalFrequencies as NaturalFrequencies,
    natural_frequencies as natural_frequencies,
)
from .analysis.parts import Parts as Parts, parts as parts
from .analysis.cue_report import CueReport as CueReport, report as report
from .analysis.plays_like import PlaysLike as PlaysLike, plays_like as plays_like
from .analysis.shop_changes import Limits as Limits
from .analysis.customer_sheet import CustomerSheet as CustomerSheet, customer_sheet as customer_sheet
from .analysis.shop_list import ShopList as ShopList, shop_list as shop_list
from .analysis.squirt_curve import SquirtCurve as SquirtCurve, squirt_curve as squirt_curve
from .analysis.strike_models import StrikeModels as StrikeModels, strike_models as strike_models
from .analysis.strike_table import StrikeTable as StrikeTable, strike_table as strike_table
from .analysis.tip_impacts import TipImpacts as TipImpacts, tip_impacts as tip_impacts
from .analysis.verdict import Verdict as Verdict, verdict as verdict
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
from .measurements.calibration import (
    CalibratedSquirt as CalibratedSquirt,
    Calibration as Calibration,
    load_calibration as load_calibration,
)
from .endmass.definitions import end_mass as end_mass
from .endmass.lumped import impulse as impulse, lump as lump
from .scene.default_scene import usual_scene as usual_scene
from .files import save as save
from .files.loaders import load as load, load_cue as load_cue, load_scene as load_scene
from .files.shop import Shop as Shop
from .files.toml_reader import Order as Order
from .files.paraview import save_motion as save_motion
from .designs.evaluation import Response as Response
from .designs.optimum import Limit as Limit, OptimumResult as OptimumResult, Problem as Problem
from .designs.sampling import Levels as Levels, Normal as Normal, Sample as Sample, Span as Span
from .designs.scatter import Scatter as Scatter, ScatterResult as ScatterResult
from .designs.study import Study as Study, Vary as Vary
from .designs.study_answer import study as study
from .designs.study_result import StudyResult as StudyResult
from .designs.sweep import SweepResult as SweepResult
from .files.errors import InputError as InputError
from .results.solved_design import SolvedDesign as SolvedDesign, solve as solve
from .parameters.scene_changes import with_parameters as with_parameters
from .quantity.unit_checks import PlausibilityWarning as PlausibilityWarning
from .solid.solid_resolution import Solid as Solid
from .solid.shaft import SolidModes as SolidModes, solid_modes as solid_modes
from .scene.scene import (
    Ball as Ball,
    Outcome as Outcome,
    Outcomes as Outcomes,
    Scene as Scene,
    Stroke as Stroke,
    Tip as Tip,
)

__version__: str

__all__: list[str]
