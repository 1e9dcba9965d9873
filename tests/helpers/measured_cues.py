"""A measured cue with fast measurements, and its folder; no tests."""

from pathlib import Path

import cuefem as cf
from cuefem.measurements.measured_cue import MeasuredCue
from cuefem.measurements.measurement_types import Measurement, Stiffness, Tone, Weight
from cuefem.measurements.uncertain_parameters import Prior

WOOD = cf.Material(E=13.86e9, G=1.2e9, rho=705.0)
SHAFT = cf.Cue((cf.Segment(0.13, 0.012, 0.0122, WOOD, 0.006, 0.006), cf.Segment(0.6, 0.0122, 0.021, WOOD)), 0.45)
SCENE = cf.Scene(SHAFT, cf.Ball(0.170, 0.028575), cf.Tip(0.73, 0.7, 1.1e-3), cf.Stroke(2.0, 0.3))
CUE_TOML = """body_mass = "450 g"

[[segments]]
length = "130 mm"
tip_diameter = "12 mm"
butt_diameter = "12.2 mm"
tip_bore = "6 mm"
butt_bore = "6 mm"
material = "hard maple"

[[segments]]
length = "600 mm"
tip_diameter = "12.2 mm"
butt_diameter = "21 mm"
material = "hard maple"
"""
MEASURED_TOML = """name = "a cue"
game = "kim"

[tip]
contact_time = "1.1 ms"

[[weight]]
value = "100 g"
error = "0.5 g"

[[tone]]
mode = 1
value = "95 Hz"
error = "0.2 Hz"

[[stiffness]]
free_length = "8 in"
value = "4600 N/m"
error = "90 N/m"
"""
# The other kinds of measurements, with zero errors of two series.
OTHER_KINDS = """
[[balance]]
value = "400 mm"
error = "2 mm"

[[squirt]]
series = "a"
offset = 0.3
left = "1.7 deg"
right = "1.5 deg"
error = "0.1 deg"

[[squirt]]
series = "b"
offset = 0.4
value = "2.5 deg"
error = "0.1 deg"
zero_error = "0.3 mm"

[[pivot_length]]
offset = 0.3
value = "300 mm"
error = "10 mm"

[[added_mass]]
mass = "10 g"
position = "50 mm"
offset = 0.3
value = "2.2 deg"
baseline = "1.6 deg"
error = "0.05 deg"

[[contact_time]]
value = "1.2 ms"
error = "0.1 ms"
"""


def measured_cue(*measurements: Measurement, priors: tuple[Prior, ...] = ()) -> MeasuredCue:
    """The cue with some measurements."""
    return MeasuredCue("a cue", SCENE, measurements, priors)


def cheap_measurements() -> tuple[Measurement, ...]:
    """Measurements that are fast to compute, with stated errors and arbitrary values."""
    tones = (Tone(mode=i + 1, value=f, error=0.2) for i, f in enumerate((95.0, 280.0, 560.0, 930.0)))
    stiff = Stiffness(value=360.0, error=7.0), Stiffness(free_length=0.2032, value=4600.0, error=90.0)
    return (Weight(value=0.1, error=5e-4), *tones, *stiff)


def measured_folder(directory: Path, measured: str = MEASURED_TOML, drawing: str = CUE_TOML) -> Path:
    """A folder of a measured cue."""
    directory.mkdir()
    (directory / "cue.toml").write_text(drawing, encoding="utf-8")
    (directory / "measured.toml").write_text(measured, encoding="utf-8")
    return directory
