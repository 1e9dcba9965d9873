"""Calibration: what the measurements of one shaft say about the squirt of the next with the same kind of tip.

The squirt factor of a shaft is its true squirt over the model's. Its logarithm has the standard deviation s, the model
error. The logarithms of two shafts differ with the standard deviation d = `SHAFT_ERROR` |ln ratio of their computed
squirt|, at least `RATIO_FLOOR`; hence their correlation is r = 1 - d^2/(2 s^2), at least 0. With m and v, mean and
variance of the measured shaft's logarithm, that of the next has the mean r m and the variance r^2 v + (1 - r^2) s^2.
Values of the tip, which both shafts share, have the mean and the covariance of the estimate.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from cuefem.cue import Array
from cuefem.files import InputError, write_atomically
from cuefem.files.schema import build, keys_of
from cuefem.files.toml_reader import load_cue, read_tables, scene_from_tables
from cuefem.measurements.estimate import Estimate
from cuefem.measurements.measurement_types import UNKNOWN_SPEED_SPREAD, BallDirection
from cuefem.measurements.uncertain_parameters import SQUIRT_MODEL
from cuefem.parameters.scene_changes import with_values_at
from cuefem.parameters.table import PARAMETERS
from cuefem.quantity.display_units import with_unit
from cuefem.results.quantities import DASH
from cuefem.results.solved_design import off_centre
from cuefem.results.uncertainty import (
    NUMERICAL_ERROR,
    RATIO_FLOOR,
    Uncertainty,
    model_error,
    model_share,
    squirt_inputs,
    squirt_of,
)
from cuefem.scene import Scene

# A squirt factor beyond PLAUSIBLE, or its inverse, causes a warning: 32 % of makers have one, at a model error of 18 %.
# One beyond MAX_FACTOR is rejected; 1 % of makers have one.
PLAUSIBLE, MAX_FACTOR = 1.2, 1.6
MIN_INFORMATION = 0.01  # part of the prior variance of the squirt factor that measurements must remove
SAME = 1e-6  # relative difference of equal values of two files
TABLE = "calibration"
TIP_OPTIONS = ("--leather", "--tip-height", "--dome", "--restitution", "--friction")
CLAIM = (
    "about 12 % for the next shaft with the same tip where published shafts agree; one series in two disagrees by "
    "35 to 40 %"
)


@dataclass(frozen=True)
class CalibratedSquirt:
    """Squirt of a stroke by a calibrated model, and what it rests on.

    Parameters
    ----------
    name : str
        The measured cue.
    offset : float
        Offset b/R.
    squirt, squirt_error : float
        Calibrated squirt and its uncertainty (1 sigma), rad.
    uncertainty, inputs : dict of str to float
        The relative uncertainty, and the part of each uncertain parameter in it, as in a `Verdict`; "model" is of the
        calibrated squirt factor, the tip's values with it.
    computed, uncalibrated_error : float
        Squirt without the calibration, rad, and its relative uncertainty.
    measured_factor : float
        Measured over computed squirt of the measured cue.
    correlation : float
        Of the squirt factors of the two shafts.
    warnings : tuple of str
        An implausible factor, and measurements that no other checks.
    """

    name: str
    offset: float
    squirt: float
    squirt_error: float
    uncertainty: dict[str, float]
    inputs: dict[str, float]
    computed: float
    uncalibrated_error: float
    measured_factor: float
    correlation: float
    warnings: tuple[str, ...]

    @property
    def factor(self) -> float:
        """Calibrated over computed squirt; other cues on a page carry the same factor."""
        return self.squirt / self.computed

    @property
    def error(self) -> float:
        """Relative uncertainty (1 sigma)."""
        return self.uncertainty["total"]

    def origin(self) -> str:
        """The measured cue, and the squirt without its measurements."""
        computed = with_unit(abs(self.computed), "rad", decimals=3)
        return (
            f"calibrated on {self.name}: {self.factor:.2f} times the computed {computed} ± "
            f"{100 * self.uncalibrated_error:.0f} %"
        )

    def basis(self) -> str:
        """What it rests on, and what it can claim."""
        return (
            f"It rests on the squirt measured on {self.name}, {self.measured_factor:.2f} times the computed one "
            f"(correlation of the two shafts {self.correlation:.2f}), and on the same tip. What it can claim: {CLAIM}."
        )

    def warning_lines(self) -> list[str]:
        """The warnings as lines of a page."""
        return [f"warning: {line}" for line in self.warnings]


@dataclass(frozen=True)
class Calibration:
    """Squirt factor and tip of a measured cue, for the next shaft with the same tip.

    Parameters
    ----------
    name : str
        The measured cue.
    scene : Scene
        Its drawing with the estimated parameters.
    drawn : mapping of str to float
        Values of the tip in the drawing before the estimate, SI, by parameter.
    log_factor : float
        Mean of the logarithm of true over computed squirt.
    covariance : tuple of tuple of float
        Of the logarithms of the values of ``drawn``, in their order, and of the squirt factor.
    unchecked : tuple of str
        Measurements that no other checks.
    without_distance : tuple of str
        Measurements of the ball's direction that count as its initial one, since they have no distance.
    without_speed : tuple of str
        Those at a distance without a speed, which count as strokes at that of the scene.

    Raises
    ------
    ValueError
        If the covariance is none, no squirt was measured, or the squirt factor is beyond `MAX_FACTOR`.
    """

    name: str
    scene: Scene
    drawn: dict[str, float] = field(hash=False)
    log_factor: float
    covariance: tuple[tuple[float, ...], ...]
    unchecked: tuple[str, ...] = ()
    without_distance: tuple[str, ...] = ()
    without_speed: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        unknown = [key for key in self.drawn if key not in PARAMETERS]
        if unknown:
            raise ValueError(f"Calibration.drawn must hold parameters of the tip; got {unknown[0]!r}")
        C, count = self.matrix, len(self.drawn) + 1
        if C.shape != (count, count) or not np.isfinite(C).all() or np.linalg.eigvalsh(C).min() < -1e-9:
            raise ValueError(
                f"Calibration.covariance must be a covariance of {count} values, those of drawn and log_factor"
            )
        if not self._information > MIN_INFORMATION:
            raise ValueError(
                "Calibration needs [[shot]], [[squirt]] or [[pivot_length]] among the measurements of the cue; "
                "got none (or one that they contradict)"
            )
        if not 1 / MAX_FACTOR <= self.measured_factor <= MAX_FACTOR:
            raise ValueError(
                f"Calibration: measured squirt must be 1/{MAX_FACTOR:g} to {MAX_FACTOR:g} times the computed one; got "
                f"{self.measured_factor:.2f}: a measurement or the drawing is wrong"
            )

    @classmethod
    def of(cls, found: Estimate) -> Calibration:
        """That of an estimate."""
        cue = found.cue
        rows = {parameter.name: i for i, parameter in enumerate(cue.parameters)}
        shared = {
            key: rows[known.name] for key, known in PARAMETERS.items() if known.is_shareable and known.name in rows
        }
        if SQUIRT_MODEL not in rows:
            raise ValueError("Calibration needs an uncertain squirt of the model; a prior of spread 0 fixes it")
        chosen = [*shared.values(), rows[SQUIRT_MODEL]]
        spreads = np.array([cue.parameters[i].spread for i in chosen])
        covariance = found.covariance[np.ix_(chosen, chosen)] * np.outer(spreads, spreads)
        directions = [each for each in cue.measurements if isinstance(each, BallDirection)]
        return cls(
            cue.name,
            cue.setup(found.z).scene,
            {key: cue.parameters[i].median for key, i in shared.items()},
            float(found.z[chosen[-1]] * spreads[-1]),
            tuple(map(tuple, covariance.tolist())),
            tuple(each.measurement.label for each in found.unchecked_measurements),
            tuple(each.label for each in directions if each.distance is None),
            tuple(each.label for each in directions if each.distance is not None and each.speed is None),
        )

    @property
    def matrix(self) -> Array:
        """``covariance`` as an array."""
        return np.atleast_2d(np.array(self.covariance, float))

    @property
    def _information(self) -> float:
        """The part of the prior variance of the squirt factor that measurements removed."""
        return float(1 - self.matrix[-1, -1] / model_error(self.scene) ** 2)

    @property
    def measured_factor(self) -> float:
        """Measured over computed squirt, without the prior."""
        return math.exp(self.log_factor / self._information)

    @property
    def warnings(self) -> tuple[str, ...]:
        """An implausible factor, and measurements that no other checks."""
        lines = []
        if not 1 / PLAUSIBLE <= self.measured_factor <= PLAUSIBLE:
            lines.append(
                f"the squirt measured on {self.name} is {self.measured_factor:.2f} times the computed one, a factor "
                f"farther from 1 than 1/{PLAUSIBLE:g} to {PLAUSIBLE:g}: check the offset of the contact, the elevation "
                "and the drawing, and measure at a second speed, before you rely on it"
            )
        lines += [f"no other measurement of {self.name} checks {label}" for label in self.unchecked]
        lines += [
            f"{label} of {self.name} has no distance and counts as the ball's initial direction: read after 1 m, a "
            "ball of 2.5 m/s from a cue raised by 3° shows a quarter less"
            for label in self.without_distance
        ]
        speed = with_unit(self.scene.stroke.speed, "m/s", 6)
        lines += [
            f"{label} of {self.name} has no speed and counts as a stroke at {speed} ± {100 * UNKNOWN_SPEED_SPREAD:.0f} "
            "%: after hard shots (ball over 4 m/s) such a calibration is worse than none, so give the cue's speed"
            for label in self.without_speed
        ]
        return tuple(lines)

    def squirt(self, scene: Scene) -> CalibratedSquirt:
        """Squirt of another shaft with the same tip and ball; at the game's default offset if the stroke is head-on.

        ValueError for another ball, another tip, or squirt of the other sign.
        """
        self.check(scene)
        return _squirt_by(self, off_centre(scene))

    def factor(self, scene: Scene) -> float:
        """Calibrated over computed squirt of a scene, as `squirt`."""
        return self.squirt(scene).factor

    def check(self, scene: Scene) -> None:
        """ValueError for a scene of another game or another tip."""
        first, second = ((each.ball.mass, each.ball.radius) for each in (self.scene, scene))
        if not np.allclose(first, second, rtol=SAME, atol=0.0):
            there, here = (f"{with_unit(m, 'kg')}, {with_unit(2 * radius, 'm')}" for m, radius in (first, second))
            raise ValueError(f"the calibration is of another game: ball {there} there, {here} here")
        if (self.scene.contact_terms.tip is None) != (scene.contact_terms.tip is None):
            raise ValueError(
                "the calibration is of another kind of tip: one is a LeatherTip (--leather), the other a spring"
            )
        for key, drawn in self.drawn.items():
            known, own = PARAMETERS[key], PARAMETERS[key].value(scene)
            if own is None or not math.isclose(own, drawn, rel_tol=SAME):
                unit = known.quantity(self.scene).unit
                there, here = (DASH if value is None else with_unit(value, unit) for value in (drawn, own))
                differs = f"{known.label} {there} there, {here} here"
                option = "--" + known.name.replace(" ", "-")
                option = f" ({option})" if option in TIP_OPTIONS else ""
                raise ValueError(
                    f"the calibration is of another tip: {differs}; if it is that tip, set {known.name} to "
                    f"{there}{option}"
                )

    def text(self) -> str:
        """The text of its file: the scene with the estimated parameters, and a table [calibration]."""
        own = {key: getattr(self, key) for key in KEYS}
        from cuefem.files.toml_writer import toml_text  # loaded when used: it loads tomlkit

        return toml_text(self.scene, **{TABLE: own})

    def save(self, path: str | Path) -> None:
        """Write it as .toml."""
        write_atomically(Path(path), lambda temporary: temporary.write_text(self.text(), encoding="utf-8"))


@lru_cache(maxsize=32)  # the verdict, the changes and the curves of one page ask for the same
def _squirt_by(calibration: Calibration, scene: Scene) -> CalibratedSquirt:
    """The squirt of an off-centre stroke of another shaft with the tip of the calibration."""
    keys, s = (*calibration.drawn,), model_error(scene)
    values = {PARAMETERS[key].steps(): PARAMETERS[key].value(calibration.scene) for key in keys}
    new = with_values_at(scene, values) if values else scene
    old = replace(calibration.scene, stroke=scene.stroke)
    after, before = squirt_of(new), squirt_of(old)
    if not after * before > 0:
        raise ValueError(f"a calibration needs squirt of one sign; got {after:.3g} and {before:.3g} rad")
    d = max(model_share(old, new) * abs(math.log(after / before)), RATIO_FLOOR)
    r = max(1 - d**2 / (2 * s**2), 0.0)
    changes = squirt_inputs(new).of("squirt")
    slopes = np.array([*(changes.get(key, 0.0) / (PARAMETERS[key].spread_in(new) or 1.0) for key in keys), r])
    covariance = calibration.matrix
    variance = float(slopes @ covariance @ slopes) + (1 - r**2) * s**2
    own = {key: abs(change) for key, change in changes.items() if key not in keys}
    shared = np.abs(slopes[:-1]) * np.sqrt(np.diag(covariance)[:-1])
    parts = Uncertainty(math.sqrt(variance), math.hypot(*own.values()), NUMERICAL_ERROR)
    computed = squirt_of(scene)
    squirt = math.exp(r * calibration.log_factor) * after
    return CalibratedSquirt(
        calibration.name,
        offset=float(scene.stroke.offset),
        squirt=squirt,
        squirt_error=parts.total * abs(squirt),
        uncertainty=parts._asdict() | {"total": parts.total},
        inputs=own | dict(zip(keys, shared.tolist(), strict=True)),
        computed=computed,
        uncalibrated_error=math.hypot(s, *squirt_inputs(scene).of("squirt").values(), NUMERICAL_ERROR),
        measured_factor=calibration.measured_factor,
        correlation=r,
        warnings=calibration.warnings,
    )


KEYS = [key for key in keys_of(Calibration) if key != "scene"]


def load_calibration(path: str | Path) -> Calibration:
    """Load the calibration that `cuefem compare FOLDER --estimate -o FILE.toml` wrote; InputError for another file."""
    path = Path(path)
    tables = read_tables(path)
    own = tables.pop(TABLE, None)
    if not isinstance(own, dict) or {*own} != {*KEYS}:
        written = "`cuefem compare FOLDER --estimate -o FILE.toml` writes it"
        if isinstance(own, dict) and {*own} < {*KEYS}:
            written += ", for a file of an older version again"
        raise InputError(path, TABLE, f"must be a table of {', '.join(KEYS)}: {written}")
    scene = scene_from_tables(tables, path, load_cue)
    return build(Calibration, own | {"scene": scene}, file=str(path), key=TABLE)
