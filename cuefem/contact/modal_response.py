"""Modal propagation: the exact response of a cue's modes to loads at its tip that are constant over a time step.

The state of a mode of angular frequency omega is its velocity v and a = omega q, its displacement in the same unit.
Under a modal load f, v' = -loss omega v - omega a + f and a' = omega v. Three kinds of damping act:

- the loss factor of a mode stays within its own 2 x 2 block, which has a closed form (`Oscillators`);
- radiation couples the few modes of the truncation correction, which a matrix exponential propagates
  (`cuefem.contact.coupled_modes`);
- a dashpot is one more port of the cue: its force over a step opposes its mean velocity over that step.

All of it depends on the cue and the length of a step: strikes at other speeds and offsets share it.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from cuefem.beam.tip_modes import TipModes
from cuefem.contact.geometric_stiffness import slope_rows
from cuefem.contact.kernel.declarations import StepTables
from cuefem.cue import Array

if TYPE_CHECKING:
    from cuefem.contact.coupled_modes import CoupledModes

NOTHING = np.zeros(0)  # a table that no mode has


class Oscillators(NamedTuple):
    """Uncoupled modes after a time t, s, each array (n,), from the state (v, a) under a constant modal load f.

    v becomes v_v v - sine a + t mean f, and a becomes a_a a + sine v + t z versine f, with z = omega t. The mean of v
    is mean v - z versine a + t versine f. Without loss v_v = a_a = cos z, sine = sin z, mean = sin(z)/z and versine =
    (1 - cos z)/z^2.
    """

    v_v: Array
    sine: Array
    a_a: Array
    mean: Array
    versine: Array

    @classmethod
    def after(cls, t: float | Array, omega: Array, loss: Array) -> Oscillators:
        """With x = loss z/2 and y^2 = z^2 - x^2 the impulse response is exp(-x) sin(y)/y.

        z^2 versine = 1 - a_a is a sum of 1 - exp(-x) - x mean and exp(-x) (1 - cos y), which are not negative.
        """
        z, ratio = omega * t, loss / 2
        x, y = ratio * z, np.sqrt(1 - ratio**2) * z
        decay = np.exp(-x)
        mean = decay * np.sinc(y / np.pi)
        from_decay = (-np.expm1(-x) - x * mean) / np.where(z > 0, z**2, 1.0)
        versine = from_decay + decay * (1 - ratio**2) * np.sinc(y / (2 * np.pi)) ** 2 / 2
        a_a = 1 - z**2 * versine
        return cls(v_v=a_a - 2 * x * mean, sine=z * mean, a_a=a_a, mean=mean, versine=versine)


class _RowVelocities(NamedTuple):
    """Velocities of ports, slopes and dashpots in a step: of_state: (r, 2 n), from the state. of_loads: (r, r)."""

    of_state: Array
    of_loads: Array

    def with_dashpots(self, dashpots: Array) -> _RowVelocities:
        """Those of the c ports and slopes, with the d dashpots' forces, (d, 2 n + c), from the state and the loads."""
        n, c = self.of_state.shape[1], len(self.of_loads) - len(dashpots)
        per_force = self.of_loads[:c, c:]
        return _RowVelocities(
            of_state=self.of_state[:c] + per_force @ dashpots[:, :n],
            of_loads=self.of_loads[:c, :c] + per_force @ dashpots[:, n:],
        )


class ModalPropagator:
    """Tip modes and their ports, and the tables by which the compiled kernel propagates them.

    tip: the modes, (n,). ports: (p, n), rows of the ports over the modal velocities, 1/sqrt(kg). slopes: (s, n), rows
    of the slopes of the bent cue (`cuefem.contact.geometric_stiffness`); none without geometric stiffness. loss: (n,)
    and dashpots: (d, n), those of the modes. radiating: (m,), indices of the modes that radiate.
    """

    def __init__(self, tip: TipModes, ports: Array, slopes: Array) -> None:
        self.tip, self.ports, self.slopes = tip, ports, slopes
        self.loss, self.dashpots = tip.loss, tip.dashpots
        self.radiating = np.flatnonzero(tip.radiation.any(axis=1))

    @cached_property
    def _group(self) -> CoupledModes:
        """The modes that radiate."""
        from cuefem.contact.coupled_modes import CoupledModes  # loaded when used: a lumped cue needs no SciPy

        omega = self.tip.omega[self.radiating]
        radiation = self.tip.radiation[np.ix_(self.radiating, self.radiating)]
        return CoupledModes(omega, radiation + np.diag(self.loss[self.radiating] * omega))

    @cached_property
    def _by_itself(self) -> Array:
        """1 of each mode that does not radiate, else 0, (n,)."""
        by_itself = np.ones(len(self.tip.omega))
        by_itself[self.radiating] = 0
        return by_itself

    @property
    def dissipates(self) -> bool:
        """Whether dashpots or loss factors take energy from the modes."""
        return bool(self.loss.any() or self.dashpots.any())

    @cached_property
    def rows(self) -> Array:
        """Rows of the ports, of the slopes and of the dashpots, (ports + slopes + dashpots, modes)."""
        return np.concatenate([self.ports, self.slopes, self.dashpots])

    @cached_property
    def mobility(self) -> Array:
        """Velocities of ports and slopes per impulse on them, 1/kg."""
        rows = np.concatenate([self.ports, self.slopes])
        return np.asarray(rows @ rows.T)

    def port_velocities(self, velocities: Array) -> Array:
        """Velocities of ports and slopes, (ports + slopes,), from those of the modes."""
        return np.asarray(self.rows[: len(self.ports) + len(self.slopes)] @ velocities)

    @property
    def fields(self) -> dict[str, Any]:
        """The modes in the kernel's input."""
        return dict(
            modes=len(self.tip.omega),
            ports=len(self.ports),
            slopes=len(self.slopes),
            dashpots=len(self.dashpots),
            radiating=len(self.radiating),
            structural_loss=bool(self.loss.any()),
            radiating_modes=self.radiating,
            omega=self.tip.omega,
            rows=self.rows,
        )

    def tables(self, h: float) -> StepTables:
        """Tables of a step of the length h, s; of 0 those of an impact."""
        return self._step_tables(h) if h else self._impact_tables()

    def _impact_tables(self) -> StepTables:
        """Impulses change the modes' velocities at once; neither oscillation nor damping acts meanwhile."""
        n, m, rows = len(self.tip.omega), len(self.radiating), self.rows
        ports = rows[: len(self.mobility)]
        velocities = np.hstack([ports, np.zeros_like(ports)])
        v, a, impulse = np.eye(3 * m).reshape(3, m, 3 * m)
        return StepTables(
            h=0.0,
            load_time=1.0,
            own=np.array([self._by_itself, np.zeros(n), self._by_itself]),
            ends=velocities,
            means=velocities,
            end_per_load=self.mobility,
            mean_per_load=self.mobility / 2,
            response=np.hstack([rows * self._by_itself, np.zeros_like(rows)]),
            dashpots=np.zeros((len(self.dashpots), 2 * n + len(ports))),
            radiating=np.vstack([v + impulse, a]),
        )

    def _step_tables(self, h: float) -> StepTables:
        omega, rows = self.tip.omega, self.rows
        after = Oscillators(*(self._by_itself * array for array in Oscillators.after(h, omega, self.loss)))
        rise = omega * h * after.versine
        end = _RowVelocities(np.hstack([rows * after.v_v, -rows * after.sine]), h * (rows * after.mean) @ rows.T)
        mean = _RowVelocities(np.hstack([rows * after.mean, -rows * rise]), h * (rows * after.versine) @ rows.T)
        radiating = self._add_radiating(h, end, mean)
        dashpots: Array = NOTHING
        if len(self.dashpots):
            # A dashpot's force is minus its mean velocity, which the state and all forces determine.
            c = len(self.ports) + len(self.slopes)
            own_response = np.eye(len(self.dashpots)) + mean.of_loads[c:, c:]
            without_dashpots = np.hstack([mean.of_state[c:], mean.of_loads[c:, :c]])
            dashpots = np.asarray(-np.linalg.solve(own_response, without_dashpots), float)
            end, mean = end.with_dashpots(dashpots), mean.with_dashpots(dashpots)
        return StepTables(
            h=h,
            load_time=h,
            own=np.array([after.v_v, after.sine, after.a_a]),
            ends=end.of_state,
            means=mean.of_state,
            end_per_load=end.of_loads,
            mean_per_load=mean.of_loads,
            response=h * np.hstack([rows * after.mean, rows * rise]),
            dashpots=dashpots,
            radiating=radiating,
        )

    def _add_radiating(self, h: float, end: _RowVelocities, mean: _RowVelocities) -> Array:
        """Add the modes that radiate to the rows' velocities in a step; their own table of `StepTables`."""
        m, rows = len(self.radiating), self.rows[:, self.radiating]
        if not m:
            return NOTHING
        columns = np.append(self.radiating, len(self.tip.omega) + self.radiating)
        state, mean_velocity = self._group.after(h)
        for velocities, of_group in ((end, state[:m]), (mean, mean_velocity)):
            velocities.of_state[:, columns] += rows @ of_group[:, : 2 * m]
            velocities.of_loads[:] += rows @ of_group[:, 2 * m :] @ rows.T
        return state


# Strikes with the same tip modes share the propagator, and those with steps of one length its tables: 0.1 to 1 MB for
# each length. The caches are those of one sweep, not of all cues of an estimate.
CACHED_CUES, CACHED_TABLES = 8, 16


@lru_cache(maxsize=CACHED_TABLES)
def repeated_tables(propagator: ModalPropagator, h: float) -> StepTables:
    """The tables of a length of steps, s, that other strikes have, too."""
    return propagator.tables(h)


@lru_cache(maxsize=CACHED_CUES)
def level_propagator(tip: TipModes, *, turns: bool) -> ModalPropagator:
    """The propagator of tip modes at the ports (u, w), and, if it turns the contact, the end section's rotation."""
    ports = [*tip.amplitude.T, tip.rotation] if turns else tip.amplitude.T
    return ModalPropagator(tip, np.array(ports), slope_rows(tip))


@lru_cache(maxsize=CACHED_CUES)
def raised_propagator(tip: TipModes) -> ModalPropagator:
    """The propagator of tip modes, which bend in two planes, at the ports (u, w, p)."""
    return ModalPropagator(*_in_two_planes(tip, slope_rows(tip, planes=2)))


def _in_two_planes(tip: TipModes, slopes: Array) -> tuple[TipModes, Array, Array]:
    """Modes, rows of the ports (u, w, p) and slopes: each bending mode a second time, in the plane out of (u, w)."""
    bending = np.flatnonzero(tip.amplitude[:, 1] != 0)
    count = len(tip.omega)
    modes = np.append(np.arange(count), bending)
    is_second = np.arange(len(modes)) >= count
    both = tip.subset(modes)
    amplitude, out_of_plane = both.amplitude.copy(), np.where(is_second, both.amplitude[:, 1], 0.0)
    amplitude[is_second] = 0.0

    def in_each_plane(rows: Array) -> Array:
        return np.concatenate([np.where(is_second, 0.0, rows), np.where(is_second, rows, 0.0)])

    two_planes = replace(
        both,
        amplitude=amplitude,
        approach=np.where(is_second, 0.0, both.approach),
        rotation=np.where(is_second, 0.0, both.rotation),
        dashpots=in_each_plane(both.dashpots),
        radiation=both.radiation * np.equal.outer(is_second, is_second),
        geometric=None,
    )
    return two_planes, np.concatenate([amplitude.T, out_of_plane[None]]), in_each_plane(slopes[:, modes])
