"""Estimates of the uncertain parameters of a measured cue from all its measurements, and the next measurement to make.

The posterior is that of the priors of `cuefem.measurements.uncertain_parameters` and of independent errors, one or two
of which may be far larger than stated (`cuefem.measurements.outliers`). Nonlinear least squares find the best fit;
the model, linearised there, gives the mean and the covariance of the posterior.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from cuefem.cue import Array
from cuefem.measurements.measured_cue import MeasuredCue, Residual, residuals_of
from cuefem.measurements.measurement_types import MEASUREMENT_TYPES, Measurement, Squirt
from cuefem.measurements.outliers import DETECTABLE, OUTLIER_FACTOR, posterior
from cuefem.results.progress import Progress

MAX_EVALUATIONS = 25  # of the search at full weights
MIN_FALL = 0.02  # of the cost over a step, relative: below it the search at full weights ends
INVALID = 1e3  # residuals of an invalid cue, such as one with a bore wider than itself: the search takes a shorter step
STEP_TOLERANCE = 0.05  # length of a step, in standard deviations of the posterior, below which the estimate converged
MAX_OUTLIER_ITERATIONS = 6  # of the search that reduces the weight of contradictory measurements
MAX_HALVINGS = 6
MAX_STEP = 1.5  # standard deviations of the priors
TARGET_OFFSET = 0.3  # b/R of the predicted squirt, if the scene has no offset


class EstimatedParameter(NamedTuple):
    """An uncertain parameter: its name, label and unit, its value in the drawing, and the estimate.

    low, high: the limits of the 68 % interval; error_ratio: the posterior's width over the prior's.
    """

    name: str
    label: str
    unit: str
    drawing: float
    value: float
    low: float
    high: float
    error_ratio: float


class InformationGain(NamedTuple):
    """Information gain of a further measurement.

    bits: about all parameters. parameter: the one whose error it reduces most; error_ratio: its error after over
    before. relative_squirt_error: the relative error of squirt after it.
    """

    measurement: Measurement
    bits: float
    parameter: str
    error_ratio: float
    relative_squirt_error: float


class UncheckedMeasurement(NamedTuple):
    """A measurement without redundancy: an outlier of ten times its error would go undetected.

    without: the parameter that depends on it most, estimated without this measurement.
    """

    measurement: Measurement
    without: EstimatedParameter


@dataclass(frozen=True, eq=False)
class Estimate:
    """The uncertain parameters of a cue after its measurements.

    z: (parameters,) posterior mean, in standard deviations of the priors. covariance: (parameters, parameters), of z.
    computed_values: (n,) of the measurements at z, SI. slopes: (n, parameters), their derivatives with respect to z.
    misfit: the least sum of squares of the residuals and of z, at full weights. converged: whether the last step was
    below `STEP_TOLERANCE`. outlier_probability: (n,) that the error of a measurement is far larger than stated.
    """

    cue: MeasuredCue
    z: Array
    covariance: Array
    computed_values: Array
    slopes: Array
    misfit: float
    converged: bool
    outlier_probability: Array

    @property
    def values(self) -> tuple[EstimatedParameter, ...]:
        """The parameters in their units."""
        return self._values(self.z, self.covariance)

    def _values(self, mean: Array, covariance: Array) -> tuple[EstimatedParameter, ...]:
        estimates = []
        for parameter, z, sd in zip(self.cue.parameters, mean, np.sqrt(np.diag(covariance)), strict=True):
            names = (parameter.name, parameter.label, parameter.unit, parameter.median)
            at, low, high = (parameter.value(float(each)) for each in (z, z - sd, z + sd))
            estimates.append(EstimatedParameter(*names, at, low, high, float(sd)))
        return tuple(estimates)

    @property
    def unchecked_measurements(self) -> tuple[UncheckedMeasurement, ...]:
        """The measurements without redundancy.

        The others predict a measurement with some error. An outlier of `OUTLIER_FACTOR` of its own errors is detected
        if that is `DETECTABLE` errors of prediction and measurement together (reliability: W. Baarda, 1968).
        """
        J, residuals = _scaled(self.cue, self.z, self.computed_values, self.slopes)
        unchecked = []
        for i, measurement in enumerate(self.cue.measurements):
            others = np.arange(len(J)) != i
            predicted_variance = J[i] @ np.linalg.solve(J[others].T @ J[others] + np.eye(len(self.z)), J[i])
            if DETECTABLE**2 * (1 + predicted_variance) > OUTLIER_FACTOR**2:
                mean, covariance, _ = posterior(J[others], residuals[others])
                largest = int(np.argmax(np.diag(covariance) / np.diag(self.covariance)))
                unchecked.append(UncheckedMeasurement(measurement, self._values(mean, covariance)[largest]))
        return tuple(unchecked)

    @property
    def residuals(self) -> tuple[Residual, ...]:
        """The measurements and the values computed with the estimated parameters."""
        spread = np.sqrt(np.einsum("ij,jk,ik->i", self.slopes, self.covariance, self.slopes))
        return residuals_of(self.cue, self.computed_values, spread)

    def predict(self, measurement: Measurement) -> tuple[float, float]:
        """Value of another measurement by the model with the estimated parameters, and its error; SI."""
        at, slope = self._values_of((measurement,))
        return float(at[0]), float(np.sqrt(slope[0] @ self.covariance @ slope[0]))

    def _values_of(self, others: Sequence[Measurement]) -> tuple[Array, Array]:
        cue = MeasuredCue(self.cue.name, self.cue.scene, (), self.cue.priors)
        cue.__dict__["parameters"] = self.cue.parameters  # those of all measurements, the zeros too
        at = cue.compute(self.z, others)
        return at, cue.jacobian(self.z, others)

    def next_measurements(self) -> tuple[InformationGain, ...]:
        """Information gain of each candidate measurement, the one with the least error of squirt first.

        Each is assumed to have the predicted value; it may also check the existing ones.
        """
        target = predicted_squirt(self.cue)
        others = [measurement for kind in MEASUREMENT_TYPES.values() for measurement in kind.candidates(self.cue.scene)]
        at, slopes = self._values_of((target, *others))
        J, residuals = _scaled(self.cue, self.z, self.computed_values, self.slopes)
        gains = []
        for measurement, slope in zip(others, slopes[1:] / [[measurement.sd] for measurement in others], strict=True):
            after = posterior(np.vstack([J, slope]), np.append(residuals, slope @ self.z)).covariance
            error_ratios = np.sqrt(np.diag(after) / np.diag(self.covariance))
            i = int(np.argmin(error_ratios))
            bits = 0.5 / np.log(2) * (np.linalg.slogdet(self.covariance)[1] - np.linalg.slogdet(after)[1])
            relative = float(np.sqrt(slopes[0] @ after @ slopes[0])) / abs(float(at[0]))
            gains.append(
                InformationGain(
                    measurement, float(bits), self.cue.parameters[i].label, float(error_ratios[i]), relative
                )
            )
        return tuple(sorted(gains, key=lambda gain: gain.relative_squirt_error))


def predicted_squirt(cue: MeasuredCue) -> Squirt:
    """The squirt that an estimate predicts, at the scene's offset; its value has no effect."""
    offset = abs(float(cue.scene.stroke.offset))
    return Squirt(offset=offset or TARGET_OFFSET, left=0.0, right=0.0, error=1.0)


def estimate(cue: MeasuredCue, *, progress: Progress = iter) -> Estimate:
    """Estimate the uncertain parameters of a cue from all measurements and priors (maximum a posteriori), with errors.

    Parameters
    ----------
    cue : MeasuredCue
        At least one measurement.
    progress : callable, optional
        Wraps the list of steps, to show progress.

    Returns
    -------
    Estimate
        The mean and the covariance of the posterior, the model linear about the mean.

    Raises
    ------
    ValueError
        If nothing was measured, or nothing is uncertain.

    Notes
    -----
    First all measurements have full weight: a trust-region Gauss-Newton method (`scipy.optimize.least_squares`), which
    shortens a step to an invalid cue. Then measurements that contradict the others get less weight. Either search ends
    when it has converged, or makes no progress: the cost falls by less than 2 %, the steps get no shorter. Cost: some
    seven steps, each two computations of all values for every parameter.
    """
    if not cue.measurements or not cue.parameters:
        missing = "measurements" if not cue.measurements else "uncertain parameters"
        raise ValueError(f"estimate takes a cue with {missing}; got none")
    measured, sd = np.array([[measurement.measured_value, measurement.sd] for measurement in cue.measurements]).T
    steps = iter(progress(range(MAX_EVALUATIONS)))

    def residuals(z: Array) -> Array:
        computed = cue.compute_or_none(z)
        return np.append(np.full(len(sd), INVALID) if computed is None else (computed - measured) / sd, z)

    def slopes(z: Array) -> Array:
        next(steps, None)
        return np.vstack([cue.jacobian(z) / sd[:, None], np.eye(len(z))])

    from scipy.optimize import least_squares  # loaded when used: half a second for every command

    best = least_squares(
        residuals,
        np.zeros(len(cue.parameters)),
        slopes,
        xtol=STEP_TOLERANCE / 10,
        ftol=MIN_FALL,
        gtol=STEP_TOLERANCE / len(cue.parameters),
        max_nfev=MAX_EVALUATIONS,
    )
    for _ in steps:  # a progress bar runs to its end
        continue
    count = len(sd)
    return _reweighted(cue, best.x, measured + sd * best.fun[:count], 2 * best.cost, best.jac[:count] * sd[:, None])


def _reweighted(cue: MeasuredCue, z: Array, at: Array, misfit: float, slopes: Array) -> Estimate:
    """The estimate about a start, in which a measurement that contradicts the others has less weight.

    at, slopes: the computed values at the start, and their derivatives.
    """
    length = np.inf
    for last in range(1, MAX_OUTLIER_ITERATIONS + 1):
        mean, covariance, outlier_probability = posterior(*_scaled(cue, z, at, slopes))
        step = mean - z
        length, before = float(np.sqrt(step @ np.linalg.solve(covariance, step))), length
        converged = length < STEP_TOLERANCE
        if converged or length >= before or last == MAX_OUTLIER_ITERATIONS:
            break
        trials = (z + _limited(step) / 2**halving for halving in range(MAX_HALVINGS))
        valid = ((trial, computed) for trial in trials if (computed := cue.compute_or_none(trial)) is not None)
        z, at = next(valid, (z, at))
        slopes = cue.jacobian(z)
    return Estimate(cue, z, covariance, at, slopes, misfit, converged, outlier_probability)


def _scaled(cue: MeasuredCue, z: Array, at: Array, slopes: Array) -> tuple[Array, Array]:
    """The linear problem about z: slopes and residuals (of z = 0) in the measurements' errors."""
    measured, sd = np.array([[measurement.measured_value, measurement.sd] for measurement in cue.measurements]).T
    J = slopes / sd[:, None]
    return J, (measured - at) / sd + J @ z


def _limited(step: Array) -> Array:
    """A step of at most `MAX_STEP` in any parameter."""
    return step / max(1.0, float(np.abs(step).max()) / MAX_STEP)
