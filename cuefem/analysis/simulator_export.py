"""Export of a scene's end mass for the simulator pooltool: its CueSpecs, beside pooltool's default.

pooltool computes squirt by [A.31] with nu = 2/5 for every ball: alpha = -atan((5/2) a sqrt(1 - a^2)/(1 + m/end_mass
+ (5/2)(1 - a^2))) in `pooltool.physics.resolve.stick_ball.squirt`; a is b/R of the contact, positive on the ball's
left, alpha positive to the left. [A.31] has neither restitution nor dome, and gives less squirt with the stick end
mass. The exported end mass is the one with which [A.31] gives the squirt of the coupled strike at the scene's offset
and speed.

Its ball speed and spin are those of [A.30], without any loss, in `pooltool.physics.resolve.stick_ball`: no CueSpecs
changes them but the cue's mass, so they stay above those of a strike whose tip loses energy.
"""

from __future__ import annotations

from dataclasses import dataclass

from cuefem.analysis.strike_models import UNCERTAINTY_NOTE
from cuefem.contact.strike import strike_modes
from cuefem.quantity.display_units import END_MASS, with_unit
from cuefem.results.closed_forms import alciatore_a30, alciatore_a31, alciatore_a31_mass_ratio
from cuefem.results.quantities import units_of
from cuefem.results.records import Record, Table, tabulate
from cuefem.scene import Scene, check_scene
from cuefem.scene.solved_scene import SolvedScene
from cuefem.show.analysis import Analysis

VERSION = "0.6.0"  # the release whose CueSpecs these are; .ci/pooltool installs it
INERTIA = 0.4  # its 5/2
DEFAULT_END_MASS = 0.170097 / 30  # kg
DEFAULT_CUE_MASS = 0.567  # kg
SHORTEST_CUE = 1.2  # m: a shorter drawing with a body mass is a shaft's
# pooltool's CueSpecs.default()
DEFAULT = {
    "brand": "Pooltool",
    "M": DEFAULT_CUE_MASS,
    "length": 1.4732,
    "tip_radius": 0.0106045,
    "shaft_radius_at_tip": 0.0065,
    "shaft_radius_at_butt": 0.02,
    "end_mass": DEFAULT_END_MASS,
}
OF_SPEEDS = ("", "pooltool_", "default_")  # prefixes of ball_speed and spin in a record
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
    own_speed, own_spin = _pooltool_strike(scene, scene.axial_mass)
    default_speed, default_spin = _pooltool_strike(scene, DEFAULT_CUE_MASS)
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
        "ball_speed": outcome.ball_speed,
        "spin": outcome.spin,
        "pooltool_ball_speed": own_speed,
        "pooltool_spin": own_spin,
        "default_ball_speed": default_speed,
        "default_spin": default_spin,
        "meaning": MEANING,
        "signs": SIGNS,
        "notes": _notes(scene),
        "units": units_of("end_mass", "length", "radius", "squirt", "contact_time")
        | {"M": "kg", "m": "kg", "R": "m", "default_end_mass": "kg", "default_squirt": "rad"}
        | {f"{whose}ball_speed": "m/s" for whose in OF_SPEEDS}
        | {f"{whose}spin": "rad/s" for whose in OF_SPEEDS},
    }


def _pooltool_strike(scene: Scene, cue_mass: float) -> tuple[float, float]:
    """Ball speed, m/s, and spin, rad/s, of pooltool's own strike; the sign of spin as in `cuefem.strike`."""
    speed, surface_speed = alciatore_a30(
        float(scene.stroke.offset),
        speed=float(scene.stroke.speed),
        mass_ratio=float(scene.ball.mass / cue_mass),
        inertia=INERTIA,
    )
    return float(speed), float(surface_speed / scene.ball.radius)


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
    check_scene("pooltool_export scene", scene)
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
    share = with_unit(scene.ball.mass / 30, END_MASS, decimals=3)
    notes = [
        "pooltool uses [A.31] at every offset and speed and has no miscue: at other offsets its squirt differs "
        "(`cuefem guide working` has a table)",
        f"pooltool computes ball speed and spin by [A.30], without loss in the tip, whatever the end mass; its default "
        f"cue is one for all games, with 1/30 of a pool ball of 170.1 g; 1/30 of this ball is {share}",
    ]
    drawn = _drawn(scene)
    if missing := [key for key in DEFAULT if key not in (*drawn, "brand", "M", "end_mass")]:
        notes.append(f"not drawn, pooltool's default: {', '.join(missing)}")
    if scene.contact_terms.table is not None:
        notes.append(
            "the cue is elevated: the end mass includes the reaction of the table, which pooltool does not model; its "
            "ball speed and spin are those of a level cue"
        )
    if scene.ball.inertia != INERTIA:
        notes.append(f"pooltool's balls have the inertia factor {INERTIA}; the scene's has {scene.ball.inertia:g}")
    return notes


def tabulate_pooltool(record: Record, written: bool) -> list[Table | str]:
    """The end mass beside pooltool's default, and the line that reads the file. written: whether there is a file."""
    time = with_unit(record["contact_time"], "s", 3)
    stroke = (
        f"b/R {record['offset']:.4g}, {with_unit(record['speed'], 'm/s', 6)}, contact time {time} (rigid cue head-on)"
    )
    release = f"pooltool {record['version']}"
    masses = (None, record["CueSpecs"]["end_mass"], record["default_end_mass"])
    squirts = (record["squirt"], record["squirt"], record["default_squirt"])
    names = ("coupled strike", f"this cue in {release}", f"its default cue in {release}")
    rows = [
        {
            "name": name,
            "mass": "" if mass is None else with_unit(mass, END_MASS, decimals=3),
            "squirt": squirt,
            "ball_speed": record[f"{whose}ball_speed"],
            "spin": record[f"{whose}spin"],
        }
        for name, mass, squirt, whose in zip(names, masses, squirts, OF_SPEEDS, strict=True)
    ]
    table = tabulate(
        f"End mass for pooltool, {stroke}",
        {"": "{name}", "end mass": "{mass}", "squirt": "squirt", "ball speed": "ball_speed", "spin": "spin"},
        rows,
        record["meaning"],
        *record["notes"],
        UNCERTAINTY_NOTE,
    )
    reads = f"pooltool {record['version']} reads it: {record['line']}"
    return [table, reads if written else f"-o cue.json writes the file; {reads}", f"install: {record['install']}"]
