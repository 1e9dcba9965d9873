"""The posterior of an estimate by a sampler, as a check of its intervals (emcee, an extra).

A strike is too slow for the ten thousands of points that a sampler asks for. So the values of the measurements are
expanded to second order about the estimate, along the axes of its covariance, and the sampler works on that; then some
of its draws are computed in full, and what the expansion misses there is told.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from cuefem.cue import Array
from cuefem.measured.documented import NEARER, Track
from cuefem.measured.estimate import Estimate, Value
from cuefem.measured.outliers import MISTAKEN, log_density
from cuefem.quantity.fields import check_count

WALKERS, BURNED = 4, 0.3  # walkers for each unknown; part of the steps that is thrown away
CHECKED = 8  # draws computed in full
STEP = 1.0  # of the expansion, in standard deviations


@dataclass(frozen=True, eq=False)
class PosteriorSample:
    """Draws of the posterior.

    z: (draws, unknowns), in standard deviations of the priors. values: median and the ends of the interval of 68 %.
    missed: root mean square, over some draws, of what the expansion misses of a computed value, in its error.
    correlation: the autocorrelation time, in steps; steps: how many were kept of each walker. acceptance: part of the
    moves that was taken.
    """

    z: Array
    values: tuple[Value, ...]
    missed: float
    correlation: float
    steps: int
    acceptance: float


def sampled(estimated: Estimate, count: int = 20_000, *, seed: int = 1, track: Track = iter) -> PosteriorSample:
    """Draw from the posterior about an estimate.

    Parameters
    ----------
    estimated : Estimate
        Where the values are expanded.
    count : int
        Draws, at least 500.
    seed : int
        The same seed gives the same draws.
    track : callable, optional
        Follows the computation of the expansion.

    Returns
    -------
    PosteriorSample

    Raises
    ------
    ModuleNotFoundError
        If emcee is not installed.

    Notes
    -----
    D. Foreman-Mackey, D. W. Hogg, D. Lang, J. Goodman, Publ. Astron. Soc. Pac. 125 (2013) 306. Cost: (n + 1)(n + 2)/2
    computations of all values for n unknowns.
    """
    try:
        import emcee
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError("sampled needs emcee: pip install '.[sample]' in the clone") from error
    check_count("sampled count", count, 500)
    expansion = SecondOrder.about(estimated, track=track)
    measured, sd = np.array([[measurement.measured, measurement.sd] for measurement in estimated.cue.found]).T

    def log_posterior(z: Array) -> Array:
        fit = log_density((measured - expansion.values(z)) / sd, MISTAKEN)
        return np.asarray(np.sum(fit, axis=-1) - 0.5 * np.sum(z**2, axis=-1))

    n = len(estimated.z)
    walkers = max(WALKERS * n, 8) // 2 * 2
    steps = -(-count // walkers)
    burned = int(np.ceil(steps * BURNED / (1 - BURNED)))
    generator = np.random.default_rng(seed)
    start = estimated.z + generator.normal(size=(walkers, n)) @ expansion.axes.T
    sampler: Any = emcee.EnsembleSampler(walkers, n, log_posterior, vectorize=True)
    sampler.run_mcmc(emcee.State(start, random_state=np.random.RandomState(seed).get_state()), burned + steps)
    z = np.asarray(sampler.get_chain(discard=burned, flat=True))
    time = float(np.max(sampler.get_autocorr_time(discard=burned, tol=0)))
    return PosteriorSample(
        z,
        _values(estimated, z),
        _missed(estimated, expansion, z[generator.integers(len(z), size=CHECKED)], sd),
        time,
        steps,
        float(np.mean(sampler.acceptance_fraction)),
    )


@dataclass(frozen=True, eq=False)
class SecondOrder:
    """Values to second order in u, z = z0 + axes u: at + J u + u' H u/2.

    J: (values, unknowns). H: (values, unknowns, unknowns).
    """

    z0: Array
    axes: Array
    at: Array
    J: Array
    H: Array

    @classmethod
    def about(cls, estimated: Estimate, *, track: Track = iter) -> SecondOrder:
        """By differences of one standard deviation along each axis, and along the sum of each pair.

        The differences are halved while they lead to a cue that cannot be.
        """
        for step in STEP * 0.5 ** np.arange(NEARER):
            try:
                return cls._over(estimated, float(step), track)
            except ValueError:  # what is possible ends there
                continue
        return cls._over(estimated, float(STEP * 0.5**NEARER), track)

    @classmethod
    def _over(cls, estimated: Estimate, step: float, track: Track) -> SecondOrder:
        axes = np.asarray(np.linalg.cholesky(estimated.covariance), float)
        n, at = len(estimated.z), estimated.computed
        unit = step * np.eye(n)

        def value(u: Array) -> Array:
            return estimated.cue.computed(estimated.z + axes @ u)

        moves = [(i, j) for i in range(n) for j in range(i, n)]
        above = {}
        J, H = np.zeros((len(at), n)), np.zeros((len(at), n, n))
        for i, j in track(moves):
            if i == j:
                above[i], below = value(unit[i]), value(-unit[i])
                J[:, i] = (above[i] - below) / (2 * step)
                H[:, i, i] = (above[i] - 2 * at + below) / step**2
        for i, j in track(moves):
            if i != j:
                mixed = value(unit[i] + unit[j]) - above[i] - above[j] + at
                H[:, i, j] = H[:, j, i] = mixed / step**2
        return cls(estimated.z, axes, at, J, H)

    def values(self, z: Array) -> Array:
        """Values at points (..., unknowns): (..., n)."""
        u = np.linalg.solve(self.axes, (z - self.z0).T).T
        return np.asarray(self.at + u @ self.J.T + 0.5 * np.einsum("...i,nij,...j->...n", u, self.H, u))


def _values(estimated: Estimate, z: Array) -> tuple[Value, ...]:
    made = []
    for i, unknown in enumerate(estimated.cue.unknowns):
        middle, low, high = (unknown.value(float(q)) for q in np.quantile(z[:, i], (0.5, 0.1587, 0.8413)))
        about = (unknown.name, unknown.words, unknown.unit, unknown.usual)
        made.append(Value(*about, middle, low, high, float(np.std(z[:, i]))))
    return tuple(made)


def _missed(estimated: Estimate, expansion: SecondOrder, z: Array, sd: Array) -> float:
    gaps = []
    for each in z:
        try:
            gaps.append((estimated.cue.computed(each) - expansion.values(each)) / sd)
        except ValueError:  # a cue that cannot be: all is missed there
            gaps.append(np.full(len(sd), np.inf))
    return float(np.sqrt(np.mean(np.square(gaps))))
