"""Natural frequencies of bending, and the amplitude of the tip in each mode."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import ClassVar, Literal, get_args

from cuefem.beam.modes import modes
from cuefem.cue import Cue
from cuefem.effects.cue_effects import Support
from cuefem.quantity.fields import quote, suggestion
from cuefem.results.quantities import UNITS
from cuefem.results.records import ColumnEntry, Record, Table, tabulate
from cuefem.results.solved_design import Solvable, SolvedDesign
from cuefem.show.analysis import Analysis, Rows
from cuefem.show.charts import Chart
from cuefem.show.drawings import modes_chart
from cuefem.show.scene_summary import effect_name

JointName = Literal["free", "pinned", "clamped"]


@dataclass(frozen=True)
class NaturalFrequencies(Rows, Analysis):
    """Natural frequencies of a cue's bending modes.

    Parameters
    ----------
    scene : Scene
        The analysed scene, with the support of its joint.
    requested_frequency, nearest_frequency : float or None
        The frequency near which modes were requested, and the nearest of them, Hz.
    rigid : int
        Number of rigid-body modes, at 0 Hz.
    frequencies : list of float
        Natural frequencies, Hz.
    tip_amplitudes : list of float
        Amplitude of the tip in each mass-normalised mode, 1/sqrt(kg).
    """

    requested_frequency: float | None
    nearest_frequency: float | None
    rigid: int
    frequencies: list[float]
    tip_amplitudes: list[float]
    has_stroke: ClassVar[bool] = False
    own_units: ClassVar[Mapping[str, str]] = MappingProxyType({"tip_amplitude": UNITS["tip_amplitudes"]})

    def heading(self) -> str:
        """The cue, and whether a scene adds a tip or other effects to what is drawn."""
        added = ", ".join(effect_name(type(effect).__name__) for effect in self.scene.effects)
        return f"{super().heading()}; frequencies {f'with {added}' if added else 'as drawn'}"

    def frame_rows(self) -> list[Record]:
        """A row for each mode."""
        pairs = zip(self.frequencies, self.tip_amplitudes, strict=True)
        return [{"frequency": frequency, "tip_amplitude": amplitude} for frequency, amplitude in pairs]

    def tables(self) -> list[Table | str]:
        """A row for each mode of the cue, with the scene's effects on the cue."""
        near, nearest = self.requested_frequency, self.nearest_frequency
        rows = [row | {"period": 1 / row["frequency"]} for row in self.frame_rows()]
        columns: dict[str, ColumnEntry] = {
            "frequency": "{frequency:frequencies}",
            "period": "{period:s}",  # in the display unit of s
            "tip amplitude": "{tip_amplitude:tip_amplitudes}",
        }
        if near is not None:
            columns[""] = lambda row: "nearest" if row["frequency"] == nearest else ""
        tip = " with its tip" if self.scene.contact_terms.tip is not None else ""
        notes = ["tip amplitude: of the mass-normalised mode", f"of the drawn part{tip}, without the butt"]
        if self.rigid:
            notes.insert(0, f"{self.rigid} rigid-body mode{'s' * (self.rigid > 1)} at 0 Hz not listed")
        title = "Natural frequencies" if near is None else f"Natural frequencies nearest {near:g} Hz"
        return [tabulate(title, columns, rows, "; ".join(notes), texts=())]

    def charts(self) -> list[Chart]:
        """The lowest mode shapes."""
        return [modes_chart(self.scene)]


def joint_supports(cue: Cue, joint: JointName) -> tuple[Support, ...]:
    """The support of the end of a drawing, its joint; ValueError for an unknown name."""
    match joint:
        case "free":
            return ()
        case "pinned":
            return (Support(cue.length, math.inf),)
        case "clamped":
            return (Support(cue.length, math.inf, math.inf),)
    names = get_args(JointName)
    raise ValueError(f"joint must be one of {', '.join(names)}; got {quote(joint)}{suggestion(str(joint), names)}")


def natural_frequencies(
    scene: Solvable, count: int = 6, *, near: float | None = None, joint: JointName = "free"
) -> NaturalFrequencies:
    """Natural frequencies of the bending modes of a scene's cue.

    Parameters
    ----------
    scene : Scene
        A scene with a cue of segments; its effects on the cue are included.
    count : int
        Number of modes.
    near : float, optional
        Frequency whose nearest modes are computed instead of the lowest, Hz.
    joint : str, optional
        How the end of the drawing is held, where a shaft has its joint: "free" (default), "pinned" or "clamped".

    Returns
    -------
    NaturalFrequencies

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.Scene(cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),), body_mass=0.43))
    >>> [round(f) for f in cf.natural_frequencies(scene, 2).frequencies]
    [128, 344]
    >>> [round(f) for f in cf.natural_frequencies(scene, 2, joint="pinned").frequencies]
    [97, 287]
    """
    scene = SolvedDesign.of(scene).scene
    supports = joint_supports(scene.shaft, joint)
    if supports:
        scene = replace(scene, effects=(*scene.effects, *supports))
    bending = modes(scene.shaft, count, near, effects=scene.cue_effects)
    amplitudes, _ = bending.shape(0.0)
    frequencies: list[float] = bending.frequencies.tolist()
    nearest = None if near is None else min(frequencies, key=lambda f: abs(f - near))
    return NaturalFrequencies(scene, near, nearest, bending.rigid, frequencies, amplitudes.tolist())
