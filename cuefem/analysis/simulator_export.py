"""Export of a scene's end mass for the simulator pooltool: its CueSpecs, beside pooltool's default.

pooltool computes squirt by [A.31] with nu = 2/5 for every ball: alpha = -atan((5/2) a sqrt(1 - a^2)/(1 + m/end_mass
+ (5/2)(1 - a^2))) in `pooltool.physics.resolve.stick_ball.squirt`; a is b/R of the contact, positive on the ball's
left, alpha positive to the left. [A.31] has neither restitution nor dome: with the stick end mass it gives 13 to 36 %
less squirt than the coupled strikes of studies/scenes and meshes. The exported end mass is the one with which [A.31]
gives the squirt of the coupled strike at the scene's offset and speed.
"""

from __future__ import annotations

from dataclasses import dataclass

from cuefem.analysis.base import Analysis
from cuefem.analysis.strike_models import UNCERTAINTY_NOTE
from cuefem.contact.strike import strike_modes
from cuefem.results.closed_forms import alciatore_a31, alciatore_a31_mass_ratio
from cuefem.results.quantities import RESULTS, units_of, with_unit
from cuefem.results.records import Record, Table, tabulate
from cuefem.scene import Scene
from cuefem.scene.solved_scene import SolvedScene

VERSION = "0.6.0"  # the release whose CueSpecs these are; .ci/pooltool installs it
INERTIA = 0.4  # its 5/2
DEFAULT_END_MASS = 0.170097 / 30  # kg
SHORTEST_CUE = 1.2  # m: a shorter drawing with a body mass is a shaft's
# pooltool's CueSpecs.default()
DEFAULT = {
    "brand": "Pooltool",
    "M": 0.567,
    "length": 1.4732,
    "tip_radius": 0.0106045,
    "shaft_radius_at_tip": 0.0065,
    "shaft_radius_at_butt": 0.02,
    "end_mass": DEFAULT_END_MASS,
}
INSTALL = (
    f"pip install --no-deps pooltool-billiards=={VERSION} (plain pip takes 0.3.3, whose CueSpecs has no end_mass; "
    "`cuefem guide working` lists what else it needs)"
)
MEANING = (
    "the mass m_e with which [A.31], tan(squirt) = (5/2) a sqrt(1 - a^2)/(1 + m/m_e + (5/2)(1 - a^2)), gives the "
    "squirt of the coupled strike at this offset a = b/R and speed; m is the ball's mass"
)
SIGNS = "a is b/R, positive on the ball's left, and alpha positive to the left: alpha(a) = -squirt(offset = a)"


def pooltool_record(name: str, scene: Scene, file: str = "cue.json") -> Record:
    """pooltool's CueSpecs of a scene's cue, and the squirt, rad, that pooltool computes from it and from its default.

    file: the JSON file that the line for pooltool reads. ValueError at offset 0 and in a miscue, without end mass.
    """
    offset, speed = float(scene.stroke.offset), float(scene.stroke.speed)
    if offset == 0:
        raise ValueError("[A.31] has no squirt at offset 0; give another --offset")
    outcome = strike_modes(scene, SolvedScene(scene).tip)
    if outcome.regime == "miscue":
        raise ValueError(f"the stroke is a miscue at offset {offset} and has no end mass")
    mass = float(scene.ball.mass / alciatore_a31_mass_ratio(offset, float(outcome.squirt), inertia=INERTIA))
    by_default = alciatore_a31(offset, mass_ratio=scene.ball.mass / DEFAULT_END_MASS, inertia=INERTIA)
    return {
        "version": VERSION,
        "install": INSTALL,
        "line": f'CueSpecs(**json.load(open("{file}"))["CueSpecs"])',
        "CueSpecs": DEFAULT | _drawn(scene) | {"brand": name, "M": scene.axial_mass, "end_mass": mass},
        "BallParams": {"m": scene.ball.mass, "R": scene.ball.radius},
        "default_end_mass": DEFAULT_END_MASS,
        "offset": offset,
        "speed": speed,
        "contact_time": scene.contact_time,
        "squirt": outcome.squirt,
        "default_squirt": by_default,
        "meaning": MEANING,
        "signs": SIGNS,
        "notes": _notes(scene),
        "units": units_of("end_mass", "length", "radius", "squirt", "contact_time")
        | {"M": "kg", "m": "kg", "R": "m", "default_end_mass": "kg", "default_squirt": "rad"},
    }


@dataclass(frozen=True)
class PooltoolExport(Analysis):
    """The input file of pooltool, and what it will compute from it.

    Parameters
    ----------
    scene : Scene
        The exported stroke.
    numbers : dict
        See `pooltool_record`.
    file : str
        The JSON file that is written, or "".
    """

    numbers: Record
    file: str

    def to_dict(self) -> Record:
        """The record that pooltool reads, with its own units."""
        about = super().to_dict()
        return about | self.numbers | {"units": about["units"] | self.numbers["units"]}

    def values(self) -> Record:
        """The numbers of `pooltool_record`."""
        return self.numbers

    def tables(self) -> list[Table | str]:
        """The end mass beside pooltool's default, and the line that reads the file."""
        return tabulate_pooltool(self.numbers, written=bool(self.file))


def pooltool_export(scene: Scene, name: str, file: str = "") -> PooltoolExport:
    """pooltool's CueSpecs of a scene's cue. name: brand of the cue. file: the JSON file that will hold it."""
    return PooltoolExport(scene, pooltool_record(name, scene, file or "cue.json"), file)


def _drawn(scene: Scene) -> Record:
    """The dimensions in the drawing, m; those of the butt only of a whole cue."""
    sizes = {"tip_radius": scene.dome_radius} if scene.dome_radius else {}
    if scene.cue.segments:
        sizes["shaft_radius_at_tip"] = scene.cue.segments[0].tip_diameter / 2
        if not scene.shaft.body_mass or scene.shaft.length >= SHORTEST_CUE:
            sizes |= {"length": scene.shaft.length, "shaft_radius_at_butt": scene.cue.segments[-1].butt_diameter / 2}
    return sizes


def _notes(scene: Scene) -> list[str]:
    notes = [
        "pooltool uses [A.31] at every offset and speed and has no miscue: at other offsets its squirt differs "
        "(`cuefem guide working` has a table)"
    ]
    drawn = _drawn(scene)
    if missing := [key for key in DEFAULT if key not in (*drawn, "brand", "M", "end_mass")]:
        notes.append(f"not drawn, pooltool's default: {', '.join(missing)}")
    if scene.contact_terms.table is not None:
        notes.append(
            "the cue is elevated: the end mass includes the reaction of the table, which pooltool does not model"
        )
    if scene.ball.inertia != INERTIA:
        notes.append(f"pooltool's balls have the inertia factor {INERTIA}; the scene's has {scene.ball.inertia:g}")
    return notes


def tabulate_pooltool(record: Record, written: bool) -> list[Table | str]:
    """The end mass beside pooltool's default, and the line that reads the file. written: whether there is a file."""
    time = with_unit(record["contact_time"], "s", 3)
    stroke = f"b/R {record['offset']:.4g}, {record['speed']:g} m/s, contact time {time} (rigid cue head-on)"
    rows = [
        ("this cue", record["CueSpecs"]["end_mass"], record["squirt"]),
        ("pooltool's default cue", record["default_end_mass"], record["default_squirt"]),
    ]
    table = tabulate(
        f"End mass for pooltool, {stroke}",
        {"": "{name}", "end mass": "{mass}", "squirt in pooltool": "squirt"},
        [
            {"name": name, "mass": f"{RESULTS['mass'].scale * mass:.3f} g", "squirt": squirt}
            for name, mass, squirt in rows
        ],
        record["meaning"],
        *record["notes"],
        UNCERTAINTY_NOTE,
    )
    reads = f"pooltool {record['version']} reads it: {record['line']}"
    return [table, reads if written else f"-o cue.json writes the file; {reads}", f"install: {record['install']}"]
