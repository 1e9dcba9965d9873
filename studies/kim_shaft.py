"""What [Kim] says of the shaft itself, its cue end, and finite elements: end mass, dome, slip, tone. Part of kim.py.

Kim's shaft (E 12.6 GPa, E/G 15, kappa 0.9), 540 g along its axis, T = 2 ms head on, 22 flexible bending modes; numbers
to four digits, which is about as exact as these modes allow.
"""

from __future__ import annotations

import dataclasses
import math

from cuefem import Ball, Outcome, Resolution, Scene, Stroke, Tip, squirt, strike
from cuefem.effects import Effect, TipDome
from cuefem.endmass.drives import end_mass
from cuefem.validation import Claim
from studies.kim_tone import CUE_MASS, DENSITY, MAPLE, MASS, SHAFT, front, nearest, pieces
from studies.kim_walk import EPS, NU_C, B, degrees, quoted

AT = Resolution(elements=8, order=4, modes=22)


def scene(*effects: Effect) -> Scene:
    """Kim's cue at b/R = 0.5."""
    cue = dataclasses.replace(front(MAPLE[1]), body_mass=CUE_MASS - MASS)
    return Scene(cue, Ball(), Tip(contact_time=2e-3), Stroke(offset=B), effects)


def slip_again(outcome: Outcome) -> float:
    """The time at which slip begins again, over the duration of the contact."""
    last = outcome.phases[-1]
    return float(last.start / outcome.duration) if last.grip != "stick" else 1.0


def four(value: float) -> float:
    """Four significant digits."""
    return float(f"{value:.4g}")


def cue_end() -> list[Claim]:
    """Section V: how long, how heavy, how stiff the cue end is."""
    base = float(squirt.base_radius(0.12, **SHAFT))
    end = {"tip_radius": SHAFT["tip_radius"], "base_radius": base}
    nu_c = float(squirt.inertia_factor(end_length=0.12, **end))
    area, r = math.pi * 0.0065**2, 0.0065
    reach = math.sqrt(2e-3 * math.sqrt(12.6e9 * math.pi * r**4 / 4 / (DENSITY * area)))
    source = "V, after eq. cue end"
    return [
        quoted("V, contact time", "period of 250 Hz", 0.004, 1 / 250, 1e-6, "s"),
        Claim("V, contact time", "contact of 0.002 s takes 'less than half a period'; half a period", 0.002, 1 / 500,
              "s",
              "slip", "it is just half a period, not less"),
        quoted("V, before eq. cue end", "ten tip diameters", 12, 10 * 2 * 0.6, 0.5, "cm"),
        Claim("V, before eq. cue end", "length of the cue end that answers in 2 ms", 12, 100 * reach, "cm",
              "not derivable",
              "read off a video; bending waves reach sqrt(T sqrt(EI/rhoA)) = 16 cm in 2 ms (12.6 GPa), "
              f"12 cm in {2 * (0.12 / reach) ** 2:.2g} ms"),
        quoted("V, before eq. cue end", "cue end over shaft by volume", 0.1, squirt.volume_ratio(0.12, **SHAFT), 0.005),
        quoted("V, eq. cue end", "m_c", 12, 1e3 * squirt.cone_end_mass(0.12, shaft_mass=MASS, **SHAFT), 0.5, "g"),
        quoted(source, "length of the pointed cone", 105.3, 100 * squirt.full_cone_length(0.12, **end), 0.05, "cm"),
        quoted(source, "base radius a", 6.77, 1e3 * base, 0.005, "mm"),
        quoted(source, "centre of mass from the base, over l", 0.48, squirt.centre_of_mass(**end), 0.005),
        Claim(source, "r_c/l", 0.5, 1 - float(squirt.centre_of_mass(**end)), "", "rounding",
              "the paper takes the middle of the cue end"),
        Claim(source, "nu_c of the cue end about its centre of mass", 1 / 3, nu_c, "", "rounding",
              f"a uniform rod's; without rotary inertia {float(squirt.inertia_factor(**end)):.4f}"),
        Claim(source, "m_c/m_e that follows, (1 + nu_c)/nu_c", 4.0, (1 + nu_c) / nu_c, "", "rounding",
              "from nu_c above"),
        quoted("V, after eq. psi=0", "epsilon = 12/210", 2 / 35, 12 / 210, 1e-15),
    ]  # fmt: skip


def impact() -> list[Claim]:
    """The shaft's end mass and squirt, and what the tip's dome and the shaft's ringing change."""
    bare, domed = strike(scene(), at=AT), strike(scene(TipDome(6e-3)), at=AT)
    felt = squirt.cue_end_mass(end_mass(scene(), drive="stick", at=AT), NU_C)
    return [
        Claim("II, first paragraph", "squirt of a domed tip, radius 6 mm, over that of a contact on the axis", 1.0,
              four(domed.squirt / bare.squirt), "", "slip",
              "the contact off the cue's axis is noticed and dropped in eq. rc; the axial force bends the shaft"),
        Claim("III, before item 1", "time at which slip begins again, over the contact's; 'an additional slip will not "
              "happen'", 1.0, four(slip_again(bare)), "", "slip", "true of a lumped cue; a vibrating shaft slips back "
              "just before it leaves"),
        Claim("V, eq. cue end", "m_c by stick end mass, (1 + nu_c)/nu_c m_e", 12, four(1e3 * felt), "g",
              "not derivable",
              "12 cm of cue end was a guess; the shaft's own bending gives this at 2 ms"),
        Claim("V, eq. squirt:psi", "squirt at b/R = 0.5 with m_c = 12 g, against the coupled strike of the shaft",
              four(degrees(B, EPS)), four(math.degrees(bare.squirt)), "deg", "not derivable",
              "the same guess"),
    ]  # fmt: skip


def tone() -> list[Claim]:
    """The 250 Hz that the author heard, beside the mode of each piece nearest to it."""
    claims = []
    for piece in pieces():
        number, (low, kim, high), needed = nearest(piece, 1)[0]
        cause = f"E = 12.6 GPa; 10 to 16 GPa give {low:.0f} to {high:.0f} Hz, 250 Hz wants {needed / 1e9:.3g} GPa"
        verdict = "agrees" if low <= 250 <= high else "slip"
        claims.append(
            Claim("V, tone", f"250 Hz as mode {number} of the {piece.name}", 250.0, kim, "Hz", verdict, cause)
        )
    return claims


def rows() -> list[Claim]:
    """The claims about the shaft."""
    return [*cue_end(), *impact(), *tone()]
