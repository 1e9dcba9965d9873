"""Estimates: exact data, coverage of intervals, next measurement, limits of the geometry (verification)."""

import pickle
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import bisect

from cuefem.measurements.estimate import Estimate, estimate
from cuefem.measurements.measured_cue import MeasuredCue, compare
from cuefem.measurements.measurement_types import MEASUREMENT_TYPES, Measurement, Stiffness, Tone, Weight
from cuefem.measurements.outliers import posterior
from cuefem.measurements.predictions import Predictions
from cuefem.measurements.uncertain_parameters import Prior
from tests.helpers.measured_cues import SCENE, cheap_measurements, measured_cue

SIGMAS_95 = 1.959964  # standard deviations of a 95 % interval
CLOSED = Prior("contact time", 0.0)  # no measurement here depends on it


def measured_as(cue: MeasuredCue, values: np.ndarray) -> MeasuredCue:
    """The cue with other values measured."""
    result = tuple(replace(one, value=float(value)) for one, value in zip(cue.measurements, values, strict=True))
    return replace(cue, measurements=result)


def random_cue(
    seed: int, measurements: tuple[Measurement, ...] = cheap_measurements(), size: float = 1.0
) -> tuple[MeasuredCue, np.ndarray]:
    """A cue with parameters drawn from their priors, measured with noise; and these parameters."""
    generator = np.random.default_rng(seed)
    cue = measured_cue(*measurements, priors=(CLOSED,))
    z = size * generator.normal(size=len(cue.parameters))
    exact = cue.compute(z)
    # errors follow the values, as a user would state them
    scaled = tuple(
        replace(one, value=float(value), error=one.error * float(value) / one.measured_value)  # type: ignore[attr-defined]
        for one, value in zip(cue.measurements, exact, strict=True)
    )
    cue = replace(cue, measurements=scaled)
    noise = generator.normal(size=len(exact)) * [one.sd for one in cue.measurements]
    return measured_as(cue, exact + noise), z


def test_estimate_exact_data_recovers_the_parameters() -> None:
    """With small errors the priors have no effect."""
    small = tuple(replace(one, error=1e-3 * one.error) for one in cheap_measurements() if not isinstance(one, Tone))  # type: ignore[attr-defined]
    cue = measured_cue(*small, priors=(CLOSED, Prior("G", 0.0), Prior("friction", 0.0), Prior("squirt model", 0.0)))
    z = np.array([0.7, -0.4, 0.5])
    result = estimate(measured_as(cue, cue.compute(z)))
    assert [parameter.name for parameter in cue.parameters] == ["E", "rho", "bore width"]
    assert result.converged
    assert result.z == pytest.approx(z, abs=2e-3)
    for value, parameter, each in zip(result.values, cue.parameters, z, strict=True):
        assert value.value == pytest.approx(parameter.value(float(each)), rel=1e-3)
        assert value.low < value.value < value.high
        assert value.error_ratio < 0.05


def test_predictions_keep_no_solved_beams() -> None:
    """Eight strikes with added masses leave their tip modes, 0.15 MB; the beams have 8 MB."""
    predictions = Predictions(SCENE)
    for mass in range(1, 9):
        predictions.squirt(0.3, added_mass=(1e-3 * mass, 0.1))
    assert len(pickle.dumps(predictions)) < 3e5


@pytest.mark.nightly
def test_intervals_of_drawn_cues_have_stated_coverage() -> None:
    """A hundred cues of four parameters drawn from the priors: 68 and 95 % intervals to three standard deviations."""
    pulls = []
    for seed in range(100):
        cue, z = random_cue(seed)
        result = estimate(cue)
        assert result.converged
        pulls.append(np.abs(result.z - z) / np.sqrt(np.diag(result.covariance)))
    for share, half_width in ((0.683, 1.0), (0.95, SIGMAS_95)):
        assert np.mean(np.array(pulls) < half_width) == pytest.approx(share, abs=3 * np.sqrt(share * (1 - share) / 400))


@pytest.fixture(scope="module")
def linear() -> tuple[MeasuredCue, np.ndarray]:
    """A cue whose measured values equal the computed ones, and their Jacobian."""
    cue = random_cue(0, size=0.0)[0]
    zero = np.zeros(len(cue.parameters))
    return measured_as(cue, cue.compute(zero)), cue.jacobian(zero)


def linear_estimate(cue: MeasuredCue, slopes: np.ndarray, values: np.ndarray) -> Estimate:
    """The estimate of a linear model with measured values ``values`` above those of the drawing."""
    sd = np.array([one.sd for one in cue.measurements])
    mean, covariance, wrong = posterior(slopes / sd[:, None], values / sd)
    base = np.array([one.measured_value for one in cue.measurements])
    off = measured_as(cue, base + values)
    return Estimate(off, mean, covariance, base + slopes @ mean, slopes, 0.0, True, wrong)


@pytest.mark.heavy
def test_outlier_probability_of_certain_parameters_is_that_of_each_error() -> None:
    """Slopes of 0: one measurement in 1,000 has ten times its error, so that two normal densities compare."""
    residuals = np.array([0.5, 3.0, 4.0])
    odds = 1e-3 / (1 - 1e-3) / 10 * np.exp(residuals**2 / 2 * (1 - 1 / 10**2))
    all_three = np.prod(odds)  # which at most two outliers exclude
    total = np.prod(1 + odds) - all_three
    each = odds * (np.prod(1 + odds) / (1 + odds)) - all_three
    found = posterior(np.zeros((3, 1)), residuals)
    assert found.outlier_probability == pytest.approx(each / total, rel=1e-12)
    assert (found.mean, found.covariance) == (pytest.approx([0.0]), pytest.approx(np.eye(1)))


def test_measurement_is_unchecked_where_others_predict_it_to_more_than_2_1_errors() -> None:
    """Ten errors of a weight must be 4.29 of prediction and measurement together, the root of 2 ln(10 / 0.001)."""
    cue = measured_cue(cheap_measurements()[0], priors=(CLOSED,))
    for spread, number in ((2.10, 0), (2.11, 1)):
        slopes = spread * cue.measurements[0].sd * np.eye(1, len(cue.parameters))
        assert len(linear_estimate(cue, slopes, np.zeros(1)).unchecked_measurements) == number


@pytest.mark.heavy
@pytest.mark.parametrize("outlier", [None, *range(7)])
def test_intervals_with_outlier_cover_or_name_it(outlier: int | None, linear: tuple[MeasuredCue, np.ndarray]) -> None:
    """One value 6 to 20 errors off: the intervals cover the true parameters, or the estimate lists it as unchecked."""
    cue, slopes = linear
    generator, sd = np.random.default_rng(26), np.array([one.sd for one in cue.measurements])
    pulls, named = [], []
    for _ in range(300):
        z = generator.normal(size=slopes.shape[1])
        noise = generator.normal(size=len(sd))
        if outlier is not None:
            noise[outlier] += generator.choice([-1, 1]) * generator.uniform(6, 20)
        result = linear_estimate(cue, slopes, slopes @ z + sd * noise)
        pulls.append(np.abs(result.z - z) / np.sqrt(np.diag(result.covariance)))
        label = None if outlier is None else cue.measurements[outlier].label
        named.append(label in {each.measurement.label for each in result.unchecked_measurements})
    covered, wide = (np.mean(np.array(pulls) < each) for each in (1.0, SIGMAS_95))
    if outlier is None:
        assert covered == pytest.approx(0.683, abs=0.04)
        assert wide == pytest.approx(0.95, abs=0.02)
        return
    if outlier == 0:  # only the weight determines the density
        assert all(named)
    elif outlier > 1:
        assert np.mean(named) < 0.5
    assert wide > {0: 0.6, 1: 0.8}.get(outlier, 0.86)


@pytest.mark.heavy
def test_next_measurement_added_gives_predicted_gain() -> None:
    """The predicted narrowing by a stiffness is that of an estimate with it, at the same values."""
    cue, _ = random_cue(9, cheap_measurements()[:4], size=0.5)
    before = estimate(cue)
    gains = before.next_measurements()
    assert {type(gain.measurement) for gain in gains} <= set(MEASUREMENT_TYPES.values())
    assert all(0 < gain.error_ratio <= 1 and gain.bits >= 0 for gain in gains)
    predicted = next(g for g in gains if isinstance(g.measurement, Stiffness) and g.measurement.free_length)
    value = before.predict(predicted.measurement)[0]
    more = replace(predicted.measurement, value=value)
    after = estimate(replace(cue, measurements=(*cue.measurements, more)))
    ratio = np.sqrt(np.diag(after.covariance) / np.diag(before.covariance))
    labels = [parameter.label for parameter in cue.parameters]
    assert predicted.parameter == labels[int(np.argmin(ratio))]
    assert predicted.error_ratio == pytest.approx(float(ratio.min()), rel=0.05)
    bits = 0.5 * np.log2(np.linalg.det(before.covariance) / np.linalg.det(after.covariance))
    assert predicted.bits == pytest.approx(bits, rel=0.05)
    assert [gain.relative_squirt_error for gain in gains] == sorted(gain.relative_squirt_error for gain in gains)


CHEAP = (
    Weight(value=0.1, error=5e-4),
    Tone(mode=1, value=95.0, error=0.2),
    Stiffness(free_length=0.2, value=4600.0, error=90.0),
)


def possible(cue: MeasuredCue, i: int, z: float) -> bool:
    """Whether the cue is valid with one parameter changed."""
    try:
        return bool(cue.setup(z * np.eye(len(cue.parameters))[i]))
    except ValueError:
        return False


@pytest.mark.parametrize(
    "name", ["taper", *(pytest.param(name, marks=pytest.mark.heavy) for name in ("E", "bore width"))]
)
def test_estimate_at_limits_of_geometry_stays_finite(name: str) -> None:
    """Differences are one-sided at a limit; limits within 12 standard deviations of the prior are tested."""
    cue = MeasuredCue("a cue", SCENE, CHEAP, (Prior("taper", 0.1),))
    i, parameter = next((i, each) for i, each in enumerate(cue.parameters) if each.name == name)
    for outside in (side for side in (-12.0, 12.0) if not possible(cue, i, side)):
        end = bisect(lambda z: possible(cue, i, z) - 0.5, 0.0, outside, xtol=1e-9)
        end -= 2e-9 * np.sign(end)
        for inside in (0.0, 0.3):
            limited = replace(cue, scene=parameter.setup(cue.setup(), end - np.sign(end) * inside).scene)
            assert np.isfinite([row.spread for row in compare(limited)]).all()
        assert np.isfinite(estimate(limited).covariance).all()
