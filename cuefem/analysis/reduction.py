"""From the drawing to squirt: modes near a frequency, effective end mass, two-part impulse solver, coupled strike."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import starmap
from typing import ClassVar, get_args

import numpy as np

from cuefem.analysis.natural_frequencies import JointName, joint_supports
from cuefem.beam.mode_count import modes_below
from cuefem.beam.modes import modes
from cuefem.contact.impulse_solver import impacts, impulse_inputs
from cuefem.contact.strike import strike_modes
from cuefem.cue import Array, Cue, LumpedCue
from cuefem.cue.materials import LEATHERS
from cuefem.effects.cue_effects import Support
from cuefem.endmass.definitions import DEFINITIONS, Drive
from cuefem.endmass.rigid_front import RigidFront
from cuefem.quantity.display_units import END_MASS, to_display, with_heading, with_unit
from cuefem.quantity.fields import Quantity
from cuefem.results.closed_forms import cue_end_mass
from cuefem.results.quantities import format_value
from cuefem.results.records import ColumnEntry, Record, Table, tabulate
from cuefem.results.solved_design import Solvable, SolvedDesign
from cuefem.scene import Scene, Stroke
from cuefem.scene.scene import DEFAULT_CONTACT_TIME
from cuefem.show.analysis import Analysis, Rows
from cuefem.show.charts import Axis, Chart, Curve, Tick, chart
from cuefem.show.scene_summary import stroke_line, tip_effect_notes

# [Kim] sec. 4
NU_C = 1 / 3  # inertia factor of the cue end, that of a uniform rod
PAPER_CUE_ENDS = {"Kim's guess": 0.012}  # m_c, kg
PAPER_LENGTH = 0.12  # of the cue end, ten diameters of the tip, m
PAPER_TONE = 250.0  # Hz

FILMED_CONTACT_TIME = LEATHERS["medium"].contact_time  # s, that the contact of a cue lasts
CONTACT_TIMES = (5e-4, 1e-3, DEFAULT_CONTACT_TIME, 3e-3)  # s, of a rigid cue
SAME_TIME = 1e-4  # relative: contact times that differ by less are equal
MAX_ROUNDS = 20  # of the search for the contact time of a filmed contact
OFFSETS = (0.1, 0.3, 0.5)  # b/R
CHART_OFFSETS = tuple(i / 20 for i in range(11))  # b/R
CHART_TIMES = tuple(i / 1e4 for i in range(4, 31))  # s
LISTED_MODES = 4
DRIVES = ("stick", "offset")  # the definitions of the end mass that a reduction compares

SMALL_OFFSETS, VIBRATING, LUMPED = "this shaft, small offsets", "this shaft, vibrating", "this cue"


@dataclass(frozen=True)
class Reduction(Rows, Analysis):
    """A cue reduced to the two-part cue of Kim's paper, and the squirt of both.

    Parameters
    ----------
    scene : Scene
        The analysed scene.
    frequencies : list of float
        The four lowest natural frequencies of the free shaft, Hz; empty for a lumped cue, as `nearest`.
    near : float
        A frequency, Hz.
    nearest : dict of str to dict
        The mode nearest to ``near`` by the support of the joint ("free", "pinned", "clamped"): "mode" (1 is the
        lowest), "frequency", Hz, and "stiffness_ratio", the factor on E and G that brings it to ``near``.
    contact_time : float
        Contact time of a rigid cue head-on, s.
    offset : float
        Tip offset b/R of the scene's stroke, without its sign.
    nu_c : float
        Inertia factor of the cue end: m_c = m_e (1 + nu_c)/nu_c.
    front_ratio : float or None
        The same m_c/m_e of the first 12 cm of this shaft, the length of the cue end in Kim's paper.
    cue_ends : dict of str to float
        The given end masses m_c of a two-part cue, kg.
    offsets : list of float
        Tip offsets b/R of every squirt.
    models : dict of str to dict
        By name, "end_mass" m_e and "cue_end_mass" m_c, kg; "eps", m_c over the mass of the ball; "rigid_length", m, the
        length of the shaft's front that has this m_e as a rigid body (None with effects at the tip, and where the whole
        shaft has less); at each offset "squirt", rad, None for a miscue, and "regime". The vibrating shaft has no end
        mass.
    missing : dict of str to str
        Why a model does not exist, by its name.
    duration : float
        How long the contact of the scene's stroke lasts, s: longer than ``contact_time`` with axial waves.
    end_mass_by_contact_time : list of dict
        "contact_time", s, of a rigid cue head-on, ascending, and the end masses without effects at the tip, kg:
        "stick", at small offsets, and "offset", at ``offset``.
    filmed_contact_time : float or None
        That of them, s, with which the contact of this cue head-on lasts as long as one that was filmed.
    """

    chart_offsets: ClassVar = CHART_OFFSETS
    chart_times: ClassVar = CHART_TIMES
    frequencies: list[float]
    near: float
    nearest: dict[str, Record]
    contact_time: float
    offset: float
    nu_c: float
    front_ratio: float | None
    cue_ends: dict[str, float]
    offsets: list[float]
    models: dict[str, Record]
    missing: dict[str, str]
    duration: float
    end_mass_by_contact_time: list[Record]
    filmed_contact_time: float | None
    design: SolvedDesign = field(repr=False, compare=False)
    cues: dict[str, LumpedCue | None] = field(repr=False, compare=False)

    def frame_rows(self) -> list[Record]:
        """A row for each model and offset."""
        return [
            {"model": name, "offset": offset}
            | {key: each[i] if type(each) is list else each for key, each in of.items()}
            for name, of in self.models.items()
            for i, offset in enumerate(self.offsets)
        ]

    def tables(self) -> list[Table | str]:
        """The steps from the drawing, and a row for each end mass with its squirt."""
        return [*([_steps_table(self)] if self.scene.cue.segments else []), _models_table(self)]

    def charts(self) -> list[Chart]:
        """Squirt against the offset, and end mass against the contact time."""
        return [_squirt_chart(self), *([_end_mass_chart(self)] if self.scene.cue.segments else [])]

    @property
    def marked_times(self) -> dict[float, str]:
        """Contact times of a rigid cue that charts mark, s, with their labels."""
        filmed = self.filmed_contact_time
        marks = {} if filmed is None else {filmed: f"filmed, {with_unit(FILMED_CONTACT_TIME, 's')}"}
        return marks | {DEFAULT_CONTACT_TIME: with_unit(DEFAULT_CONTACT_TIME, "s")}

    def squirt_curves(self) -> dict[str, Array]:
        """Squirt of every model at `CHART_OFFSETS`, rad; nan for a miscue."""
        strokes = {name: _strokes(self.design, cue, CHART_OFFSETS) for name, cue in self.cues.items()}
        return {name: np.array(record["squirt"], float) for name, record in strokes.items()}

    def end_mass_curves(self) -> dict[str, Array]:
        """End mass at `CHART_TIMES` by the model's name, kg; nan where there is none."""
        rows = [_end_masses_at(self.design, time) for time in CHART_TIMES]
        names = (SMALL_OFFSETS, *([_at_offset_name(self.scene)] if self.offset else []))
        curves = {name: [row[drive] for row in rows] for name, drive in zip(names, DRIVES, strict=False)}
        curves |= {name: [self.models[name]["end_mass"]] * len(rows) for name in self.cue_ends}
        return {name: np.array(values, float) for name, values in curves.items()}


def reduction(
    scene: Solvable,
    *,
    near: float = PAPER_TONE,
    cue_ends: Mapping[str, float] | None = None,
    offsets: Sequence[float] = OFFSETS,
) -> Reduction:
    """Reduce a cue to its effective end mass, and compare the squirt of the two-part cue with that of the shaft.

    Parameters
    ----------
    scene : Scene, or what `cuefem.solve` returns
        Cue, ball, tip and stroke, or a solved one. End masses are those of the scene's contact time, that of a rigid
        cue head-on; Kim's paper states 2 ms.
    near : float
        A frequency, Hz, such as that of a tap: the mode nearest to it is listed.
    cue_ends : dict of str to float, optional
        End masses m_c of a two-part cue by name, kg, at most the mass of the cue, to compare with. By default the 12 g
        of Kim's paper, and none beside a lumped cue.
    offsets : sequence of float
        Tip offsets b/R, in (-1, 1), of the squirts, one at least.

    Returns
    -------
    Reduction
        Show it with ``print``, in a notebook, or by ``.save("reduction.html")``.

    Raises
    ------
    ValueError
        If a number is out of bounds.

    Notes
    -----
    The two-part cue moves axially with its whole mass, and transversely with a cue end of mass m_c whose inertia
    factor nu_c is 1/3 ([Kim] sec. 4). Its effective end mass is m_e = m_c nu_c/(1 + nu_c), a quarter of m_c, and its
    eps = m_c/M. The shaft has the m_e of `cuefem.end_mass`, "stick" at small offsets and "offset" at that of the
    stroke; `cuefem.impulse` computes the squirt of a two-part cue, `cuefem.strike` that of the vibrating shaft.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=782.0)
    >>> cone = cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood, kappa=0.9),), body_mass=0.42)
    >>> kim = cf.reduction(cf.Scene(cone, tip=cf.Tip(contact_time=2e-3), stroke=cf.Stroke(offset=0.3)))
    >>> {name: round(1e3 * model["cue_end_mass"]) for name, model in kim.models.items() if model["cue_end_mass"]}  # g
    {"Kim's guess": 12, 'this shaft, small offsets': 32, 'this shaft, b/R 0.3': 27}
    """
    near = Quantity("Hz", "(0, inf)").check("reduction near", near)
    if not len(offsets):
        raise ValueError("reduction offsets must be at least one b/R between -1 and 1; got none")
    offsets = [Stroke(offset=offset).offset for offset in offsets]
    design = SolvedDesign.of(scene)
    scene = design.scene
    front = RigidFront.of(scene.cue) if isinstance(scene.cue, Cue) else None
    if cue_ends is None:
        masses = dict(PAPER_CUE_ENDS) if front else {}
    else:
        wanted = cue_end_quantity(scene)
        masses = {name: wanted.check(f"reduction cue_ends[{name!r}]", mass) for name, mass in cue_ends.items()}
    own, missing = _own_cues(design)
    filmed = _filmed_contact_time(design) if front else None
    times = sorted([*CONTACT_TIMES, *([] if filmed is None else [filmed])]) if front else []
    cues = {name: LumpedCue.two_part(scene.axial_mass, mass, NU_C) for name, mass in masses.items()} | own
    return Reduction(
        scene,
        frequencies=_frequencies(scene, LISTED_MODES, ()) if front else [],
        near=near,
        nearest=_nearest_modes(scene, near) if front else {},
        contact_time=float(scene.contact_time),
        offset=abs(scene.stroke.offset),
        nu_c=NU_C,
        front_ratio=front.mass_ratio(PAPER_LENGTH) if front else None,
        cue_ends=masses,
        offsets=offsets,
        models={name: _model(design, cue, offsets, front) for name, cue in cues.items()},
        missing=missing,
        duration=float(design.strike().duration),
        end_mass_by_contact_time=[_end_masses_at(design, time) for time in times],
        filmed_contact_time=filmed,
        design=design,
        cues=cues,
    )


def cue_end_quantity(scene: Scene) -> Quantity:
    """The m_c of a two-part cue, which is a part of the cue's mass."""
    return Quantity("kg", f"(0, {scene.axial_mass!r}]")


def _at_offset_name(scene: Scene) -> str:
    return f"this shaft, b/R {abs(scene.stroke.offset):.4g}"


def _own_cues(design: SolvedDesign) -> tuple[dict[str, LumpedCue | None], dict[str, str]]:
    """The lumped cues of the scene's cue by name, None for its coupled strike; and why an end mass does not exist."""
    scene = design.scene
    if scene.lumped is not None:
        return {LUMPED: scene.lumped}, {}
    drives: dict[str, Drive] = {SMALL_OFFSETS: "stick"}
    if scene.stroke.offset:  # head-on, both are the same
        drives[_at_offset_name(scene)] = "offset"
    cues: dict[str, LumpedCue | None] = {}
    missing = {}
    for name, drive in drives.items():
        try:
            cues[name] = LumpedCue(scene.axial_mass, design.end_mass(drive, None))
        except ValueError as error:
            missing[name] = str(error)
    return cues | {VIBRATING: None}, missing


def _model(design: SolvedDesign, cue: LumpedCue | None, offsets: Sequence[float], front: RigidFront | None) -> Record:
    """End mass and squirts of a lumped cue; of the vibrating shaft, None, the squirts."""
    masses: Record = dict.fromkeys(("end_mass", "cue_end_mass", "eps", "rigid_length"))
    if cue is not None:
        masses["end_mass"] = cue.end_mass
        masses["cue_end_mass"] = float(cue_end_mass(cue.end_mass, NU_C))
        masses["eps"] = masses["cue_end_mass"] / design.scene.ball.mass
        if front is not None and not design.scene.at_tip:
            masses["rigid_length"] = front.length_of(cue.end_mass)
    return masses | _strokes(design, cue, offsets)


def _strokes(design: SolvedDesign, cue: LumpedCue | None, offsets: Sequence[float]) -> Record:
    """Squirt, rad, None for a miscue, and contact state at each offset: of a lumped cue, or of the vibrating shaft."""
    if cue is None:
        outcomes = [design.strike(offset) for offset in offsets]
        squirts, regimes = [float(each.squirt) for each in outcomes], [str(each.regime) for each in outcomes]
    else:
        many = impacts(impulse_inputs(design.scene, cue)._replace(offset=np.array(offsets)))
        squirts, regimes = many.squirt.tolist(), many.regime.tolist()
    valid = [None if regime == "miscue" else squirt for squirt, regime in zip(squirts, regimes, strict=True)]
    return {"squirt": valid, "regime": regimes}


def _nearest_modes(scene: Scene, near: float) -> dict[str, Record]:
    """The mode nearest to a frequency, Hz, for each support of the joint."""
    count = modes_below(scene.shaft, 2 * math.pi * near) + 4  # a support adds up to two, and the next may be nearer
    nearest = {}
    for name in get_args(JointName):
        frequencies = _frequencies(scene, count, joint_supports(scene.shaft, name))
        mode = int(np.argmin(np.abs(np.array(frequencies) - near)))
        frequency = frequencies[mode]
        nearest[name] = {"mode": mode + 1, "frequency": frequency, "stiffness_ratio": (near / frequency) ** 2}
    return nearest


def _frequencies(scene: Scene, count: int, supports: Sequence[Support]) -> list[float]:
    """The lowest natural frequencies of the shaft with its effects and supports, Hz."""
    bending = modes(scene.shaft, count, effects=(*scene.cue_effects, *supports))
    return [float(frequency) for frequency in bending.frequencies]


def _with_contact_time(scene: Scene, contact_time: float) -> Scene:
    """The scene without effects at the tip, with another contact time of a rigid cue, s."""
    scene = scene.without_tip_effects
    return replace(scene, tip=replace(scene.tip, contact_time=contact_time, stiffness=None))


def _filmed_contact_time(design: SolvedDesign) -> float | None:
    """The contact time of a rigid cue with which a head-on contact lasts `FILMED_CONTACT_TIME`; None if none does.

    Without axial waves both are equal; with them a contact lasts longer than that of a rigid cue.
    """
    head_on = replace(design.scene, stroke=replace(design.scene.stroke, offset=0.0))

    time = FILMED_CONTACT_TIME
    try:
        for _ in range(MAX_ROUNDS):
            outcome = strike_modes(_with_contact_time(head_on, time), design.solved.step_tip)
            ratio = float(outcome.duration) / FILMED_CONTACT_TIME
            if abs(ratio - 1) < SAME_TIME:
                return time
            time /= ratio  # the duration is nearly proportional to the contact time of a rigid cue
    except (ValueError, RuntimeError):  # a number beside the answer does not take it down
        pass
    return None


def _end_masses_at(design: SolvedDesign, contact_time: float) -> Record:
    """End masses without effects at the tip for another contact time, s; None where there is none."""
    scene = _with_contact_time(design.scene, contact_time)
    masses: Record = {"contact_time": contact_time}
    for drive in DRIVES:
        try:
            masses[drive] = float(DEFINITIONS[drive].of(design.solved.step_tip, scene))
        except ValueError:
            masses[drive] = None
    return masses


def _steps_table(own: Reduction) -> Table:
    """Drawing, modes and end mass, in the order of the chain."""
    end_mass = own.models.get(SMALL_OFFSETS, {"end_mass": None})["end_mass"]
    rows = (
        ("drawing", _drawing(own.scene.shaft)),
        ("natural frequencies", f"{', '.join(f'{each:.0f}' for each in own.frequencies)} Hz (free)"),
        (f"modes near {own.near:g} Hz", ", ".join(starmap(_nearest_mode, own.nearest.items()))),
        (
            f"effective end mass, contact time {with_unit(own.contact_time, 's')}",
            f"{format_value('end_mass', end_mass)} (small offsets)",
        ),
        ("end mass by contact time", ", ".join(_end_mass_at(row, own) for row in own.end_mass_by_contact_time)),
    )
    without = " and no effects at the tip" if own.scene.at_tip else ""
    notes = (
        f"free, pinned, clamped: the joint end of the shaft; E × : the factor on E and G that gives {own.near:g} Hz",
        f"contact time: of a rigid cue head-on; the contact of this stroke lasts {with_unit(own.duration, 's')}",
        f"end mass by contact time: small offsets{without}; {with_unit(DEFAULT_CONTACT_TIME, 's')} in Kim's paper; "
        f"filmed: a contact that lasts {with_unit(FILMED_CONTACT_TIME, 's')}, as one with a leather tip was filmed",
    )
    return Table("From the drawing to squirt", ("step", "result"), rows, notes, texts=(0, 1))


def _drawing(cue: Cue) -> str:
    ends = (cue.segments[0].tip_diameter / 2, cue.segments[-1].butt_diameter / 2)
    first, last, length = (with_unit(size, "m") for size in (*ends, cue.length))
    shaft, whole = (format_value("mass", mass) for mass in (cue.shaft_mass, cue.mass))
    return f"radius {first} to {last}, length {length}, {shaft}; cue {whole}"


def _nearest_mode(support: str, mode: Record) -> str:
    return f"{support} {mode['frequency']:.0f} Hz (mode {mode['mode']}, E × {mode['stiffness_ratio']:.2f})"


def _end_mass_at(row: Record, own: Reduction) -> str:
    """The end mass of a contact time; marks the filmed one."""
    filmed = " (filmed)" if row["contact_time"] == own.filmed_contact_time else ""
    return f"{format_value('end_mass', row['stick'])} at {with_unit(row['contact_time'], 's')}{filmed}"


def _models_table(own: Reduction) -> Table:
    """A row for each end mass, and for the vibrating shaft."""
    rows = [{"name": name, **model} for name, model in own.models.items()]
    columns: dict[str, ColumnEntry] = {"cue": "{name}", "m_e": "end_mass", "m_c": "cue_end_mass", "ε": "{eps:.3f}"}
    if any(row["rigid_length"] for row in rows):
        columns["rigid length"] = "rigid_length"
    for index, offset in enumerate(own.offsets):
        columns[f"at {offset:g}" if index else f"squirt at b/R {offset:g}"] = _squirt_column(index)
    return tabulate("Two-part cue and vibrating shaft", columns, rows, *_model_notes(own))


def _squirt_column(index: int) -> ColumnEntry:
    return lambda row: format_value("squirt", row["squirt"][index])


def _model_notes(own: Reduction) -> list[str]:
    front = "" if own.front_ratio is None else f"; the first 12 cm of this shaft: {own.front_ratio:.2f}"
    has_lengths = any(model["rigid_length"] for model in own.models.values())
    return [
        stroke_line(own.scene),
        "m_e: effective end mass, at the tip; m_c = 4 m_e: end mass of Kim's two-part cue (ν_c = 1/3, a uniform rod"
        f"{front}); ε = m_c/M, over the mass of the ball",
        *(["rigid length: of the shaft's front that has this m_e as a rigid body"] if has_lengths else []),
        "squirt: of a two-part cue by the impulse solver; of the vibrating shaft by the coupled strike, in time",
        *(f"{name}: {reason}" for name, reason in own.missing.items()),
        *tip_effect_notes(
            own.scene,
            "m_e includes the effects at the tip: it is for the impulse solver, and for programs that take an end mass",
        ),
    ]


def _style(own: Reduction, name: str) -> str:
    """CSS class of a model's curve."""
    styles = {VIBRATING: "c1", LUMPED: "c1", SMALL_OFFSETS: "c2", _at_offset_name(own.scene): "c3"}
    return styles.get(name, "c5")


def _squirt_chart(own: Reduction) -> Chart:
    curves = [
        Curve(name, CHART_OFFSETS, np.degrees(squirt), _style(own, name))
        for name, squirt in own.squirt_curves().items()
    ]
    return chart("Squirt", curves, x=Axis("tip offset b/R", 0.0, CHART_OFFSETS[-1]), y=Axis("squirt, degrees"))


def _end_mass_chart(own: Reduction) -> Chart:
    times = to_display(CHART_TIMES, "s")
    curves = [
        Curve(name, times, to_display(mass, END_MASS), _style(own, name))
        for name, mass in own.end_mass_curves().items()
    ]
    return chart(
        "Effective end mass",
        curves,
        x=Axis(with_heading("contact time of a rigid cue", "s"), 0.0, float(times[-1])),
        y=Axis(with_heading("effective end mass", END_MASS)),
        marks=[Tick(float(to_display(time, "s")), label) for time, label in own.marked_times.items()],
    )
