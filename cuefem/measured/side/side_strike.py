"""The strike from the side: the striker meets the vibrating beam in time (handbook: The side strike).

It is the head-on contact of `cuefem.contact` with the beam's motion at the place that is struck in place of the cue's
along its axis.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from cuefem.beam.mesh import ActsOnCue, ForcedNode
from cuefem.beam.tip import TipModes, side_modes
from cuefem.contact.laws import LEAST_RESTITUTION, TOLERANCE, ContactModel, check_lively, power_law
from cuefem.contact.outcome import Phase
from cuefem.contact.propagator import planar_propagator
from cuefem.contact.solve import SolvedContact, solve_contact
from cuefem.contact.strike import tip_loss
from cuefem.measured.side.side_scene import SideStrike
from cuefem.quantity.fields import CONTACT_TIME, check_kind
from cuefem.scene import Resolution, equal_fields
from cuefem.tip_modes import resolution_for

if TYPE_CHECKING:
    from cuefem.beam.modes import Modes


@dataclass(frozen=True, eq=False)
class SideOutcome:
    """What a strike from the side leaves behind.

    Attributes
    ----------
    rebound_speed : float
        Of the striker, m/s; positive if it bounces back, negative if it goes on in its old direction.
    apparent_restitution : float
        e_A, the rebound speed over the speed of the strike.
    impulse : float
        Between striker and beam, N s.
    duration : float
        Of the contact, s; of the last one with `SecondHit`, from the first touch on.
    effective_mass : float
        m_e = m (1 + e_A)/(e - e_A), kg: of the free mass from which the striker would bounce in the same way. Infinite
        for a beam that bounces it like a wall; negative for one that throws it back faster than a wall would.
    place_speed : float
        Of the place that was struck, at the end of the contact, m/s, in the direction of the strike.
    phases : tuple
        The course of the contact (`cuefem.contact.outcome.Phase`); impulses are (0, along the strike), N s.
    energy : dict
        J by name: "initial", and the parts that add up to it: "striker", "beam" (its rigid motion), "beam vibration",
        "contact loss", and what effects add.
    unknowns : int
        Of the model that was solved.
    error : float or None
        Estimated error of e_A (`resolve_side_strike`); None if nothing estimated it.
    history : History
        Force and velocity of the contact at any time of it: called with times, s, it gives a dict of arrays, of which
        "force_n" is the force, N, and "velocity_n" the velocity of striker against beam, m/s, negative while they
        approach.
    """

    rebound_speed: float
    apparent_restitution: float
    impulse: float
    duration: float
    effective_mass: float
    place_speed: float
    phases: tuple[Phase, ...]
    energy: dict[str, float]
    unknowns: int = 0
    error: float | None = None
    history: Any = None

    __eq__ = equal_fields
    __hash__ = None  # type: ignore[assignment]


def side_strike(scene: SideStrike, at: Resolution | None = None) -> SideOutcome:
    """Strike a beam from the side, and follow the contact in time.

    Parameters
    ----------
    scene : SideStrike
        What is there, and which effects act.
    at : Resolution, optional
        How finely the beam is computed: the plain sum over the modes asked for. By default modes are kept by frequency
        and completed by a tail, so that e_A is within 1e-4. `cuefem.resolve_side_strike` reaches an accuracy that is
        asked for.

    Returns
    -------
    SideOutcome

    Raises
    ------
    ValueError
        If the contact would take less than 1e-6 s or more than 10 s.
    RuntimeError
        If the striker does not leave the beam.

    Notes
    -----
    Striker, contact and the beam's modes are one system, and the modes turn exactly between the contact's forces, so
    that the modes kept are the only approximation that counts: the steps add about 1e-12, 1e-10 with Hertz's law.
    The energies add up to 1e-10. Handbook: The side strike.

    Examples
    --------
    A rigid rod that is free and hit at its end is felt as a quarter of its mass, but for the rotary inertia of its
    sections:

    >>> import cuefem as cf
    >>> rigid = cf.Material(E=1e16, G=1e16, rho=700.0)
    >>> rod = cf.Cue((cf.Segment(0.7, 0.012, 0.012, rigid),))
    >>> ball = cf.Striker(mass=0.02, restitution=0.8, contact_time=1e-3)
    >>> outcome = cf.side_strike(cf.SideStrike(rod, ball), cf.Resolution(elements=1, order=6, modes=2))
    >>> round(rod.mass / outcome.effective_mass, 6)
    3.999298
    """
    check_kind("side_strike scene", scene, SideStrike)
    solved = SideSolved(scene, at)
    return outcome_of(solved_side(scene, solved.place), scene)


@dataclass(frozen=True, eq=False)
class SideSolved:
    """A scene and the modes of its beam, solved when first asked for; nothing here depends on the striker's speed.

    at: as in `side_strike`; by default modes are ended by a tail.
    """

    scene: SideStrike
    at: Resolution | None = None

    @cached_property
    def modes(self) -> Modes:
        """The bending modes of the beam, with its effects."""
        from cuefem.beam.modes import solve
        from cuefem.beam.system import assemble
        from cuefem.beam.tail import tail

        scene, at = self.scene, self.at or default_side_resolution(self.scene)
        system = assemble(scene.cue, elements=at.elements, order=at.order, effects=acting(scene))
        solved = solve(system, at.modes + 2 - system.rigid.shape[1])
        return solved if self.at is not None else tail(solved, position=scene.position)

    @cached_property
    def place(self) -> TipModes:
        """What the striker feels of the beam."""
        return place_modes(self.modes, self.scene)


def acting(scene: SideStrike) -> tuple[ActsOnCue, ...]:
    """What acts on the beam: its effects, and a node where it is struck."""
    return *scene.cue_effects, ForcedNode(scene.position)


def default_side_resolution(scene: SideStrike) -> Resolution:
    """The default resolution: modes up to 30 periods in a contact, and at least 40."""
    return resolution_for(scene.cue, checked_time(scene))


def checked_time(scene: SideStrike) -> float:
    """The scene's contact time, s; ValueError if it is out of all bounds."""
    time = scene.contact_time
    if not CONTACT_TIME.holds(time):
        raise ValueError(f"SideStrike must make a contact time in {CONTACT_TIME.bounds}; got {time:.3g} s")
    return time


def place_modes(modes: Modes, scene: SideStrike) -> TipModes:
    """What the striker feels of a beam of these modes, with what effects add to them."""
    place = side_modes(modes, scene.position)
    for effect in scene.cue_effects:
        place = effect.damp(place, scene.cue, (modes,))
    return place


def solved_side(scene: SideStrike, place: TipModes, *, recorded: bool = True) -> SolvedContact:
    """The contact of the strike when it is over: one along the normal alone, of a body that comes in."""
    striker, law, time = scene.striker, scene.striker.law, checked_time(scene)
    check_lively("Striker.restitution", striker.restitution)
    if scene.window is not None and striker.restitution == 0:
        raise ValueError(f"SecondHit takes a Striker.restitution in [{LEAST_RESTITUTION:g}, 1]; got 0.0")
    model = ContactModel(
        planar_propagator(place, turning=False, time=time),
        facing=np.array([[0.0, -1.0, 1.0, 0.0, 1.0], [-1.0, 0.0, 0.0, 1.0, 0.0]]),
        ball_gives=np.full(3, 1 / striker.mass),
        ball=np.array([0.0, -scene.speed, 0.0]),
        phi=0.0,
        ball_mass=striker.mass,
        inertia=1.0,
        restitution=striker.restitution,
        friction=math.inf,
        speed=scene.speed,
        time=time,
        law=law,
        terms=power_law(law) | {"tolerance": TOLERANCE},
        window=scene.window,
    )
    return solve_contact(model, recorded=recorded)


def outcome_of(solved: SolvedContact, scene: SideStrike) -> SideOutcome:
    """The outcome of a contact that is over."""
    m, e = scene.striker.mass, scene.striker.restitution
    rebound = float(solved.ball[1])
    apparent = rebound / scene.speed
    return SideOutcome(
        rebound_speed=rebound,
        apparent_restitution=apparent,
        impulse=m * (rebound + scene.speed),
        duration=solved.time,
        effective_mass=m * (1 + apparent) / (e - apparent) if e != apparent else math.inf,
        place_speed=solved.velocity[1] - rebound,
        phases=solved.phases,
        energy=_energy(solved, scene, rebound),
        unknowns=solved.model.unknowns,
        history=solved.history(1.0),
    )


def _energy(solved: SolvedContact, scene: SideStrike, rebound: float) -> dict[str, float]:
    rigid, vibrating = solved.cue_energy
    account = {
        "initial": scene.striker.mass * scene.speed**2 / 2,
        "striker": scene.striker.mass * rebound**2 / 2,
        "beam": rigid,
        "beam vibration": vibrating + solved.losses["radiated"],
        "contact loss": tip_loss(solved),
    }
    if solved.model.propagator.lossy:
        account["damping loss"] = solved.losses["damping"]
    return account
