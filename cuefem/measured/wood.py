"""The tap test: E, G and density of a shaft's wood from the tones that it rings with, hung free.

The tones fix E/rho and G/rho; the weighed mass fixes rho. Its error comes from the tones (`cuefem.measured.tones`),
from the beam and the drawing (`MODEL`), from the scale, and from G/E, if the tones do not tell G from E and the file's
ratio is kept.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from cuefem.contact.strike import strike
from cuefem.cue import Array, Cue, Material
from cuefem.effects import Effect
from cuefem.endmass.drives import end_mass
from cuefem.measured.chance import by_chance
from cuefem.measured.doubts import DENSITY, KEPT, refusals, remarks, shear_coefficients
from cuefem.measured.fit import Matched, TapFit
from cuefem.measured.matching import FACTOR, RIVAL, ModeTable, Shaft, assigned
from cuefem.measured.strings import Note, better_note
from cuefem.measured.tones import Tone
from cuefem.parts import main_material, with_material
from cuefem.quantity.fields import Quantity, check_kind
from cuefem.scene import Scene

MODEL = 2e-3  # relative, of a mode's frequency: diameters to 0.1 %, uneven grain, the beam
SCALE = 0.5e-3  # kg, error of a kitchen scale
TOLD = 0.15  # ln G/E: the tones determine it if they leave it uncertain by less than this
ODD = 0.15  # relative change of density by the weighed mass that is worth a word
STEP = 0.02  # of differences in the logarithms, for the numbers that follow from the wood
OUTLIER = 4.5  # standard deviations
STEPS, SETTLED = 8, 1e-9  # steps of the least squares; change of the logarithms at which they have converged
FOLDED = 1e-3  # relative error of a tone that may be a whole multiple of another


@dataclass(frozen=True)
class Predicted:
    """A number of the scene: with the fitted wood, its standard deviation (the wood's alone), with the file's wood."""

    value: float
    error: float
    before: float


class TapTest:
    """A hung shaft, ready for recordings.

    segment: the one whose material is sought; by default it is the main material (`main_material`). mass: of the shaft
    as it hangs, weighed, kg. model: relative error of a mode's frequency. effects: of a scene; point masses and joints
    stay on the shaft, supports do not. Cost: 27 solutions of the modes, once. ValueError if the mass asks for a density
    further than a factor `FACTOR` from the file's.
    """

    def __init__(
        self,
        cue: Cue,
        *,
        segment: int | None = None,
        mass: float | None = None,
        effects: tuple[Effect, ...] = (),
        model: float = MODEL,
    ) -> None:
        check_kind("TapTest cue", cue, Cue)
        self.model = Quantity("", "[0, 1)").check("TapTest model", model)
        wood = main_material(cue, segment)
        hung = tuple(effect for effect in effects if effect.part_of_cue)
        self.shaft, self.weighed, self.notes = Shaft(cue, wood, hung), mass is not None, list[str]()
        self.rho, self.rho_error = (wood.rho, DENSITY) if mass is None else self._weigh(mass)
        self.table = ModeTable(self.shaft, self.rho)

    def _weigh(self, mass: float) -> tuple[float, float]:
        """(density of the wood, its relative error)."""
        mass = Quantity("kg", "(0, inf)").check("mass", mass)
        cue, wood = self.shaft.cue, self.shaft.wood
        drawn = cue.shaft_mass + sum(effect.mass_on(cue) for effect in self.shaft.effects)
        own = with_material(cue, wood, replace(wood, rho=2 * wood.rho)).shaft_mass - cue.shaft_mass
        others = drawn - own
        low, high = others + own / FACTOR, others + own * FACTOR
        if not low <= mass <= high:
            bound = (
                f"{1e3 * low:.4g} to {1e3 * high:.4g} g, the wood's density within a factor {FACTOR:g} of the file's"
            )
            raise ValueError(f"mass of the shaft must be {bound}; got {1e3 * mass:.4g} g")
        rho = wood.rho * (mass - others) / own
        if abs(rho / wood.rho - 1) > ODD:
            self.notes.append(
                f"{1e3 * mass:.4g} g makes the wood {rho:.0f} kg/m³, the file has {wood.rho:.0f} (a shaft of "
                f"{1e3 * drawn:.4g} g): check the scale and the drawing; weigh the drawn shaft alone"
            )
        return rho, SCALE / (mass - others)

    def fit(self, tones: Sequence[Tone], rate: float | None = None) -> TapFit:
        """The wood that explains the tones best; rate: of the recording, by its file, samples a second.

        RuntimeError if they are not the bending tones of any such shaft.
        """
        used = [tone for tone in tones if tone.kind in ("tone", "harmonic")]
        hypotheses = self.table.hypotheses(used) if used else []
        clear = sum(tone.kind == "tone" for tone in used)
        explained = sum(mode >= 0 for mode in hypotheses[0].modes) if hypotheses else 0
        if explained < (2 if clear >= 3 else 1):
            tell = ", ".join(f"{tone.frequency:.0f}" for tone in used[:6])
            raise RuntimeError(
                f"tones must be bending tones of this shaft, its E within a factor {FACTOR:g} of the file's; "
                f"got {tell or 'none'} Hz: check the drawing and that the shaft hung free"
            )
        heard = np.log([tone.frequency for tone in used])
        doubt = [FOLDED if tone.kind == "harmonic" else 0.0 for tone in used]
        sd = np.hypot(np.hypot([tone.error / tone.frequency for tone in used], self.model), doubt)
        own, theta = np.array(hypotheses[0].modes), np.array([*hypotheses[0].theta, np.log(self.rho)])
        for _ in range(4):
            theta, covariance, told, f = self._solved(theta, heard, own, sd)
            pulls = np.abs(heard - f[own])[own >= 0] / sd[own >= 0]
            again = assigned(heard, f, OUTLIER * max(1.0, 1.48 * float(np.median(pulls))) * sd)
            if (again == own).all() or (again >= 0).sum() < (own >= 0).sum() / 2:
                break
            own = again
        modes = {id(tone): int(k) for tone, k in zip(used, own, strict=True) if k >= 0}
        matched = tuple(
            Matched(tone, modes[id(tone)] + 1, float(np.exp(f[modes[id(tone)]])))
            if id(tone) in modes
            else Matched(tone, None, None)
            for tone in tones
        )
        rivals = [(h, hypotheses[0].score - h.score) for h in hypotheses[1:]]
        rivals = [(h, odds) for h, odds in rivals if odds < RIVAL]
        told_by = by_chance(self.table, tones), better_note(used, hypotheses[0].score), rate
        return self._told(np.exp(f), matched, theta, covariance, told, rivals, *told_by)

    def _told(
        self,
        frequencies: Array,
        matched: Any,
        theta: Array,
        covariance: Array,
        told: bool,
        rivals: Any,
        chance: float,
        note: Note | None,
        rate: float | None,
    ) -> TapFit:
        E, ratio, rho = map(float, np.exp(theta))
        wood = replace(self.shaft.wood, E=E, G=ratio * E, rho=rho)
        ours = [m for m in matched if m.mode is not None]
        gaps = np.array([m.tone.frequency / m.frequency - 1 for m in ours])
        trust = np.array([(m.tone.error / m.tone.frequency) ** 2 + MODEL**2 for m in ours])
        fit = TapFit(
            cue=with_material(self.shaft.cue, self.shaft.wood, wood),
            frequencies=frequencies,
            wood=wood,
            before=self.shaft.wood,
            covariance=covariance,
            matched=matched,
            told=told,
            weighed=self.weighed,
            rivals=tuple((float(np.exp(h.theta[0])), float(np.exp(odds))) for h, odds in rivals),
            loss=float(np.median([m.tone.loss for m in ours])),
            misfit=float(np.sqrt(np.average(gaps**2, weights=1 / trust))),
            notes=(),
            chance=chance,
            note=note,
        )
        edge = bool(told and not self.shaft.ratios[0] < theta[1] < self.shaft.ratios[1])
        doubts, kappa = tuple(refusals(fit, edge=edge)), shear_coefficients(fit.cue, wood)
        notes = (*self.notes, *remarks(fit, rate))
        return replace(fit, notes=notes, shear_coefficients=kappa, refusals=doubts)

    def _solved(self, theta: Array, heard: Array, own: Array, sd: Array) -> tuple[Array, Array, bool, Array]:
        """(ln E, ln G/E, ln rho), their covariance, whether the tones tell G, and ln of the frequencies there.

        Least squares by Gauss and Newton. The slopes are those of the start: it lies so near that two or three steps
        bring the frequencies themselves, which are computed anew at every step, to the least squares.
        """
        J = slopes(self.shaft.log_frequencies, theta, step=1e-4)
        f = self.shaft.log_frequencies(theta)
        for _ in range(STEPS):
            rows, right = self._rows(theta, f, J, heard, own, sd)
            told = _tells_ratio(rows)
            free = self._free(told=told)
            step = np.array([0.0, 0.0 if told else self.shaft.start[1] - theta[1], 0.0])
            step[free] = np.linalg.lstsq(rows[:, free], right - rows @ step)[0]
            before, theta = theta, theta + step
            theta[1] = np.clip(theta[1], *self.shaft.ratios)
            f = self.shaft.log_frequencies(theta)
            if np.abs(theta - before).max() < SETTLED:
                break
        rows, right = self._rows(theta, f, J, heard, own, sd)
        freedom = max(len(rows) - 2 - told, 1)
        rows[:-1] /= np.sqrt(max(1.0, float(right[:-1] @ right[:-1]) / freedom))  # tones that fit badly count less
        return theta, _covariance(rows, self._free(told=told)), told, f

    def _free(self, *, told: bool) -> list[int]:
        """Which of (ln E, ln G/E, ln rho) are sought; the others are the file's."""
        return [0, *([1] if told else []), *([2] if self.weighed else [])]

    def _rows(self, theta: Array, f: Array, J: Array, heard: Array, own: Array, sd: Array) -> tuple[Array, Array]:
        """The linear least-squares problem at theta: one row for each matched tone, and a last one for the density."""
        here = own >= 0
        rows = np.vstack([J[own[here]] / sd[here, None], [0, 0, 1 / self.rho_error]])
        right = np.append((heard - f[own])[here] / sd[here], (np.log(self.rho) - theta[2]) / self.rho_error)
        return rows, right


def _tells_ratio(rows: Array) -> bool:
    """Whether the tones leave G/E less than `TOLD`: what remains of its column beside the others."""
    if len(rows) < 3:
        return False
    triangle: Any = np.linalg.qr(rows[:, [0, 2, 1]], mode="r")
    remains = abs(triangle[2, 2])
    return bool(remains * TOLD > 1)


def _covariance(rows: Array, free: list[int]) -> Array:
    """Covariance of (ln E, ln G/E, ln rho), including what the errors of kept values do to the others."""
    inner = np.linalg.inv(rows[:, free].T @ rows[:, free])
    covariance = np.zeros((3, 3))
    covariance[np.ix_(free, free)] = inner
    # the last row is that of the scale, which says nothing about a density that is kept
    for known in {0, 1, 2} - set(free):
        tones = rows[:-1] if known == 2 else rows
        drift = np.zeros(3)
        drift[known], drift[free] = 1.0, -inner @ tones[:, free].T @ tones[:, known]
        covariance += {1: KEPT, 2: DENSITY}[known] ** 2 * np.outer(drift, drift)
    return covariance


def slopes(of: Callable[[Array], Any], theta: Array, *, step: float) -> Array:
    """Central differences of a function of (ln E, ln G/E, ln rho): (..., 3)."""
    moves = step * np.eye(len(theta))
    return np.stack([np.asarray(of(theta + move) - of(theta - move)) / (2 * step) for move in moves], axis=-1)


def predicted(scene: Scene, fit: TapFit) -> dict[str, Predicted]:
    """Stick end mass, kg, and squirt at the scene's offset, rad, with the fitted wood.

    Errors: linear propagation of the wood's covariance alone, by central differences. Cost: eight strikes.
    """

    def with_wood(wood: Material) -> Array:
        here = replace(scene, cue=with_material(fit.cue, fit.wood, wood))
        return np.array([end_mass(here), strike(here).squirt], float)

    def at(theta: Array) -> Array:
        E, ratio, rho = np.exp(theta)
        return with_wood(replace(fit.wood, E=E, G=ratio * E, rho=rho))

    wood = fit.wood
    theta, fitted = np.log([wood.E, wood.G / wood.E, wood.rho]), with_wood(wood)
    slope = slopes(at, theta, step=STEP)
    errors = np.sqrt(np.einsum("ij,jk,ik->i", slope, fit.covariance, slope))
    values = zip(fitted, errors, with_wood(fit.before), strict=True)
    return {name: Predicted(*map(float, v)) for name, v in zip(("end_mass", "squirt"), values, strict=True)}
