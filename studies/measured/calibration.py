"""Does a calibration on one shaft predict the squirt of the next as well as it states?

200 simulated makers measure an old maple shaft (pivot length to 5 %, weight, three tones) and predict the squirt of a
new bored one with the same tip. Inputs of both shafts are drawn from their priors, the tip's in common; the squirt
factors of the two shafts from the law that a calibration assumes. Each maker's estimate takes Gauss-Newton steps with
the slopes at the drawing. Further laws, in which each shaft has an error of its own, are computed by the formula alone.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np

from cuefem.measurements.calibration import PLAUSIBLE, Calibration
from cuefem.measurements.estimate import Estimate
from cuefem.measurements.measured_cue import MeasuredCue
from cuefem.measurements.measurement_types import Measurement, PivotLength, Tone, Weight
from cuefem.measurements.uncertain_parameters import SQUIRT_MODEL
from cuefem.parameters.table import PARAMETERS
from cuefem.results.uncertainty import MODEL_ERROR, RATIO_FLOOR, SHAFT_ERROR, squirt_of
from studies.pages import Study, page, rms, table
from studies.strokes import cue, full_model

MAKERS, SAMPLES, STEPS = 200, 200_000, 3
OFFSET = 0.3  # b/R of the predicted squirt
PIVOT = 0.05  # relative error
INPUTS = 0.065  # of the formula alone: relative error of squirt by unmeasured inputs
RATIO = 0.22  # of the formula alone: logarithm of the ratio of two shafts' squirt


def correlation(ratio: float) -> float:
    """Correlation of the squirt factors of two shafts, of whose computed squirt the ratio has this logarithm."""
    d = max(SHAFT_ERROR * abs(ratio), RATIO_FLOOR)
    return max(1 - d**2 / (2 * MODEL_ERROR**2), 0.0)


@cache
def makers() -> np.ndarray:
    """A row for each maker: ln(true over predicted squirt), stated error, that without calibration, ln(true over
    computed squirt) and measured factor."""
    old, new = (MeasuredCue(name, full_model(cue(name), OFFSET), ()) for name in ("pool_maple", "pool_hollow"))
    blank = (PivotLength(offset=0.375, value=1.0, error=1.0), Weight(value=1.0, error=1.0))
    kinds: tuple[Measurement, ...] = (*blank, *(Tone(mode=mode, value=1.0, error=1.0) for mode in (1, 2, 3)))
    medians = replace(old, measurements=kinds).compute(np.zeros(len(old.parameters)))
    slopes = replace(old, measurements=kinds).jacobian(np.zeros(len(old.parameters)))
    errors = np.array([PIVOT * medians[0], 5e-4, *(0.1 for _ in range(3))])
    r = correlation(math.log(squirt_of(new.scene) / squirt_of(old.scene)))
    names = [[parameter.name for parameter in each.parameters] for each in (old, new)]
    tip = {known.name for known in PARAMETERS.values() if known.is_shareable}
    draw = np.random.default_rng(7)
    rows = []
    while len(rows) < MAKERS:
        first, second = draw.standard_normal(len(names[0])), draw.standard_normal(len(names[1]))
        for name in tip & {*names[0]}:
            second[names[1].index(name)] = first[names[0].index(name)]
        common = draw.multivariate_normal([0, 0], [[1, r], [r, 1]])
        first[names[0].index(SQUIRT_MODEL)], second[names[1].index(SQUIRT_MODEL)] = common
        noise = draw.standard_normal(len(kinds))
        try:
            true = old.compute(first, kinds) + errors * noise
            setup = new.setup(second)
            squirt = setup.squirt_factor * setup.predictions.squirt(OFFSET)
            made = Calibration.of(_estimate(old, kinds, true, errors, slopes))
            found = made.squirt(new.scene)
        except ValueError:  # no valid cue, or a factor beyond what a calibration takes
            continue
        computed = squirt_of(new.scene)
        rows.append(
            (
                math.log(squirt / found.squirt),
                found.error,
                found.uncalibrated_error,
                math.log(squirt / computed),
                made.measured_factor,
            )
        )
    return np.array(rows)


def _estimate(
    old: MeasuredCue, kinds: tuple[Measurement, ...], true: np.ndarray, errors: np.ndarray, slopes: np.ndarray
) -> Estimate:
    """The estimate from measured values."""
    J = slopes / errors[:, None]
    covariance = np.linalg.inv(J.T @ J + np.eye(J.shape[1]))
    z = np.zeros(J.shape[1])
    for _ in range(STEPS):
        at = old.compute(z, kinds)
        z = covariance @ J.T @ ((true - at) / errors + J @ z)
    values = [replace(kind, value=float(v), error=float(e)) for kind, v, e in zip(kinds, true, errors, strict=True)]
    measured = MeasuredCue(old.name, old.scene, tuple(values))
    return Estimate(measured, z, covariance, at, slopes, 0.0, True, np.zeros(len(kinds)))


def formula(own: float | None) -> tuple[float, float, float]:
    """Coverage of 1 and 2 sigma and RMS by the formula alone; own: error of each shaft alone, None for the law."""
    draw, s, r = np.random.default_rng(0), MODEL_ERROR, correlation(RATIO)
    if own is None:
        first, second = s * draw.multivariate_normal([0, 0], [[1, r], [r, 1]], SAMPLES).T
    else:
        shared = math.sqrt(s**2 - own**2) * draw.standard_normal(SAMPLES)
        first, second = shared + own * draw.standard_normal((2, SAMPLES))
    error = math.hypot(PIVOT, INPUTS)
    gain = s**2 / (s**2 + error**2)
    measured = first + error * draw.standard_normal(SAMPLES)
    stated = math.sqrt(r**2 * s**2 * (1 - gain) + (1 - r**2) * s**2 + INPUTS**2)
    off = second + INPUTS * draw.standard_normal(SAMPLES) - r * gain * measured
    return float(np.mean(abs(off) < stated)), float(np.mean(abs(off) < 2 * stated)), float(off.std())


@cache
def text() -> str:
    """The page."""
    off, stated, without, alone, factor = makers().T
    shares = [float(np.mean(abs(off) < k * stated)) for k in (1, 2)]
    far = (factor > PLAUSIBLE) | (factor < 1 / PLAUSIBLE)
    rows = [
        [f"{MAKERS} makers, whole chain", *(f"{100 * x:.1f}" for x in (*shares, stated.mean(), rms(off)))],
        *(
            [label, *(f"{100 * x:.1f}" for x in formula(own)[:2]), "–", f"{100 * formula(own)[2]:.1f}"]
            for label, own in (
                ("formula alone, the law that is assumed", None),
                ("formula alone, each shaft with an error of its own of 5 %", 0.05),
                ("formula alone, of 10 %", 0.10),
            )
        ),
    ]
    return page(
        "Calibration on one shaft",
        "Does a calibration on one shaft predict the squirt of the next as well as it states?",
        f"Yes, if shafts differ as the published pairs do: of {MAKERS} simulated makers {100 * shares[0]:.0f} % are "
        f"within 1σ and {100 * shares[1]:.0f} % within 2σ of a stated error of {100 * stated.mean():.0f} %, which is "
        f"{100 * without.mean():.0f} % without calibration. If each shaft has an error of its own of 10 %, half are "
        "within 1σ.",
        "An old maple shaft is measured (pivot length to 5 %, weight, three tones), and the squirt of a new bored one "
        "with the same tip is predicted:",
        table(["simulation", "within 1σ, %", "within 2σ, %", "stated error, %", "RMS error, %"], rows),
        f"Without calibration the RMS error of the {MAKERS} makers is {100 * rms(alone):.1f} %. A squirt factor beyond "
        f"1/{PLAUSIBLE:g} to {PLAUSIBLE:g}, which causes a warning, has {100 * far.mean():.0f} % of them; of these "
        f"{100 * np.mean((abs(off) < stated)[far]):.0f} % are within 1σ. Factors beyond 1.6 are rejected.",
        "The claim is no more than this: about 12 % for the next shaft with the same tip if its squirt is within 30 % "
        "of the measured one's, provided that shafts differ as the published pairs do (uncertainty.md).",
    )


EXAMPLE = """\
import cuefem as cf

made = cf.estimate("studies/measured/predator_z").calibration()
found = made.squirt(cf.usual_scene(cf.load("low deflection")))
print(found.origin())
print(f"instead of {100 * found.uncalibrated_error:.0f} %")
"""
STUDY = Study(__file__, text, example=EXAMPLE)

if __name__ == "__main__":
    STUDY.write()
