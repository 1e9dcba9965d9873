"""Central impacts of a leather tip on a rigid cue."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from cuefem.quantity.display_units import displayed_system, modulus_text, significant, with_unit
from cuefem.results.quantities import DASH, RESULTS, format_value
from cuefem.results.records import Record, Table, tabulate
from cuefem.results.solved_design import Solvable, SolvedDesign
from cuefem.show.analysis import Analysis, Rows

SPEEDS = (0.5, 1.0, 2.0, 3.0, 5.0, 8.0)  # m/s


@dataclass(frozen=True)
class TipImpacts(Rows, Analysis):
    """Central impacts of a leather tip at several speeds, on an axially rigid cue.

    Parameters
    ----------
    scene : Scene
        The analysed scene, with a LeatherTip.
    tip_mass : float
        Mass of the leather, kg.
    E : float
        Young's modulus of the leather, Pa.
    impacts : list of dict
        By speed, m/s: contact time, s, maximum force, N, and at that force indentation, m, stiffness, N/m, and contact
        diameter, m; None where the indentation is beyond the valid range of the force law.
    """

    tip_mass: float
    E: float
    impacts: list[Record]

    def frame_rows(self) -> list[Record]:
        """A row for each speed."""
        return self.impacts

    def tables(self) -> list[Table | str]:
        """A row for each speed."""
        columns = {RESULTS[name].label: name for name in ("contact_time", "force", "indentation", "patch")}
        outside = any(impact["force"] is None for impact in self.impacts)
        made = tabulate(
            "Leather tip, head-on impact",
            {"speed": "{speed:m/s}", **columns, "stiffness": _stiffness},
            self.impacts,
            f"leather of {format_value('tip_mass', self.tip_mass)}, E {modulus_text(self.E)}; force, "
            "indentation, contact diameter and stiffness at maximum indentation",
            f"contact time: of a rigid cue, without axial waves; a measured one is longer (medium leather, "
            f"{with_unit(2.0, 'm/s')}: 1.135 ms)",
            *([f"{DASH}: indentation beyond the valid range of the force law"] if outside else []),
            texts=(),
        )
        return [made]


def tip_impacts(scene: Solvable) -> TipImpacts:
    """Central impacts of a scene's leather tip at several speeds.

    Parameters
    ----------
    scene : Scene
        A scene with a LeatherTip.

    Returns
    -------
    TipImpacts

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43))
    >>> [round(1e3 * impact["contact_time"], 2) for impact in cf.tip_impacts(scene).impacts]  # ms
    [1.22, 1.04, 0.87, 0.79, 0.69, 0.6]
    """
    scene = SolvedDesign.of(scene).scene
    leather = scene.leather_tip
    diameter = leather.diameter_on(scene.shaft.segments[0].tip_diameter)
    law = scene.tip_law(float(scene.tip.restitution))
    patches, depths, _ = leather.head_on(diameter, float(scene.ball.radius))

    def impact(speed: float) -> Record:
        try:
            indentation, loading = law.central_impact(scene.reduced_mass, speed)
        except ValueError:
            return dict.fromkeys(("contact_time", "force", "indentation", "stiffness", "patch")) | {"speed": speed}
        return {
            "speed": speed,
            "contact_time": (1 + law.restitution) * loading,
            "force": float(law.at(indentation)[0]),
            "indentation": float(indentation),
            "stiffness": float(law.slope(indentation)),
            "patch": 2 * float(np.interp(indentation, depths, patches)),
        }

    impacts = [impact(speed) for speed in sorted({*SPEEDS, float(scene.stroke.speed)})]
    return TipImpacts(scene, leather.mass(diameter), leather.E, impacts)


def _stiffness(impact: Mapping[str, Any]) -> str:
    value = impact["stiffness"]
    if value is None:
        return DASH
    return with_unit(value, "N/m", decimals=0) if displayed_system() == "us" else f"{significant(1e-6 * value)} kN/mm"
