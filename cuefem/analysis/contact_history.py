"""The contact of one strike over time: force, velocity, and the events."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import ClassVar

import numpy as np

from cuefem.results.quantities import format_value
from cuefem.results.records import Record, Table
from cuefem.results.solved_design import Solvable, SolvedDesign
from cuefem.scene import Outcome
from cuefem.show.analysis import Analysis, Rows
from cuefem.show.charts import Chart
from cuefem.show.contact_charts import contact_section

FRAME_TIMES = 201


@dataclass(frozen=True)
class ContactHistory(Rows, Analysis):
    """The contact over time, and where the energy went.

    Parameters
    ----------
    scene : Scene
        The analysed stroke.
    energy : dict of str to float
        Energy before the strike and by place after it, J.
    outcome : Outcome
        The strike.
    """

    energy: Record
    outcome: Outcome = field(repr=False)
    own_units: ClassVar[Mapping[str, str]] = MappingProxyType(
        {"time": "s", "force_t": "N", "force_n": "N", "velocity_t": "m/s", "velocity_n": "m/s"}
    )

    def frame_rows(self) -> list[Record]:
        """Force on the ball and velocity of the tip over the contact; none of an impact."""
        if self.outcome.history is None:
            return []
        times = np.linspace(0.0, self.outcome.duration, FRAME_TIMES)
        columns = {"time": times, **self.outcome.history(times)}
        return [dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)]

    def charts(self) -> list[Chart]:
        """Force and velocity of the tip against time, if the strike has a history."""
        return [] if self.outcome.history is None else contact_section(self.outcome)["charts"]

    def tables(self) -> list[Table | str]:
        """The events, and the energy balance."""
        events = [] if self.outcome.history is None else contact_section(self.outcome)["events"]
        whole = self.energy["initial"]
        rows = (
            (name, f"{100 * value / whole:.2f} %", format_value("energy", value) if abs(value) > 1e-9 * whole else "0")
            for name, value in self.energy.items()
            if name != "initial"
        )
        balance = Table("Energy balance", ("", "share", "energy"), tuple(rows))
        timed = [Table("Events", ("", "time", "event"), tuple(events), texts=(0, 2))] if events else []
        return [*timed, balance]


def contact_history(scene: Solvable) -> ContactHistory:
    """Force and velocity of the tip over time, the events of the contact, and where the energy went.

    Parameters
    ----------
    scene : Scene
        A stroke.

    Returns
    -------
    ContactHistory
        Energies in J.

    Raises
    ------
    TypeError
        If it is not a Scene.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43))
    >>> energy = cf.contact_history(scene).energy
    >>> round(energy["ball translation"] / energy["initial"], 3)
    0.417
    """
    design = SolvedDesign.of(scene)
    return ContactHistory(design.scene, design.strike().energy, design.strike())
