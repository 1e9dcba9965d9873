"""Axial waves of a cue: against a chain of masses in small steps, a drawn butt, and a closed form (verification)."""

import math
from dataclasses import replace

import numpy as np
import pytest

import cuefem as cf
from cuefem.beam.axial_modes import rod_modes
from cuefem.cue.materials import MATERIALS
from cuefem.scene.solved_scene import SolvedScene
from studies.strokes import cue as reference_cue

MAPLE = MATERIALS["hard maple"].material
TIP = cf.Tip(0.73, 0.7, contact_time=1.1e-3)


def head_on(cue: cf.Cue) -> cf.Scene:
    return cf.Scene(cue, cf.Ball(), TIP, cf.Stroke(1.0, 0.0), (cf.AxialWaves(),))


def contact_of(outcome: cf.Outcome, cue: cf.Cue) -> tuple[float, float]:
    """Contact time, s, and apparent restitution: that of an axially rigid cue with the same ball speed."""
    return outcome.duration, outcome.ball_speed * (1 + cf.Ball().mass / cue.mass) - 1


def step_chain(cue: cf.Cue, pieces: int = 100) -> tuple[float, float]:
    """Contact time, s, and apparent restitution of a chain of masses and springs behind the tip's spring."""
    x = np.linspace(cue.leather_height, cue.length, pieces + 1)
    inside = cue.section((x[:-1] + x[1:]) / 2)
    h = x[1] - x[0]
    springs, lumps = inside.EA / h, inside.rhoA * h
    m = np.r_[0.0, lumps / 2] + np.r_[lumps / 2, 0.0]
    m[0] += sum(
        s.mass for s, end in zip(cue.segments, cue.nodes[1:], strict=True) if end <= cue.leather_height * 1.000001
    )
    m[-1] += cue.body_mass
    k, e = head_on(cue).stiffness, TIP.restitution
    v, strain = np.ones(pieces + 1), np.zeros(pieces)
    ball = compression = max_compression = time = 0.0
    dt = 0.2 * h / math.sqrt(MAPLE.E / MAPLE.rho)
    while True:
        max_compression = max(max_compression, compression)
        force = max(k * max_compression - k / e**2 * (max_compression - compression), 0.0)
        if time > 0 and force == 0:
            return time, ball * (1 + cf.Ball().mass / cue.mass) - 1
        net = np.r_[0.0, springs * strain] - np.r_[springs * strain, 0.0]
        net[0] -= force
        v += dt * net / m
        ball += dt * force / cf.Ball().mass
        strain += dt * (v[:-1] - v[1:])
        compression += dt * (v[0] - ball)
        time += dt


def test_axial_waves_equal_chain_of_masses() -> None:
    """Axial waves change 1.1 ms and 0.73 by about 0.16 ms and 0.05."""
    cue = reference_cue("pool_maple")
    assert contact_of(cf.strike(head_on(cue)), cue) == pytest.approx(step_chain(cue), rel=2e-3)


BUTT = {"cue_length": 1.4732, "butt_diameter": 0.03175}


def test_axial_waves_stated_butt_equals_drawn_butt():
    """The stated butt equals a tapered segment of its mass and wave speed along the axis, and is absent across it."""
    waves, cue = cf.AxialWaves(**BUTT, wave_speed=4430.0), reference_cue("pool_maple")
    drawn, scene = waves.with_butt(cue), replace(head_on(cue), effects=(waves,))
    butt = drawn.segments[-1]
    assert (drawn.length, drawn.mass) == pytest.approx((1.4732, cue.mass), rel=1e-12)
    assert (butt.material.E / butt.material.rho) ** 0.5 == pytest.approx(4430.0, rel=1e-12)
    assert contact_of(cf.strike(scene), cue) == pytest.approx(contact_of(cf.strike(head_on(drawn)), drawn), rel=1e-5)
    assert cf.end_mass(scene, "velocity") == cf.end_mass(head_on(cue), "velocity")
    ends = [replace(waves, cue_length=cue.length + behind).with_butt(cue) for behind in (0.0499, 0.0501)]
    assert [end == cue for end in ends] == [True, False]


def test_axial_waves_narrow_joint_end_is_inside_the_butt() -> None:
    """The butt continues the last full section, whatever pin or chamfer is drawn behind it."""
    cue = reference_cue("pool_maple")
    last, squirts = cue.segments[-1], []
    for end in (0.02, 1e-3, 2e-4):
        pin = cf.Segment(0.0036, last.butt_diameter, end, last.material)
        drawn = replace(cue, segments=(*cue.segments, pin))
        squirts.append(cf.strike(cf.usual_scene(drawn)).squirt)
        assert cf.AxialWaves(**BUTT, wave_speed=4430.0).with_butt(drawn).mass == pytest.approx(drawn.mass, rel=1e-12)
    assert squirts == pytest.approx([cf.strike(cf.usual_scene(cue)).squirt] * 3, rel=2e-3)


@pytest.mark.parametrize("cutoff", [1e3, 2e5])
def test_rod_truncation_correction_has_compliance_of_all_modes(cutoff):
    """A free uniform rod on springs of s per mass under a steady force at its end: the sum of along^2/(omega^2 + s),
    for the shift s = 10 (c/L)^2 of the truncation correction, is coth(L sqrt(s)/c) / sqrt(s EA rhoA), rigid-body
    motion included."""
    cue = cf.Cue((cf.Segment(0.7, 0.012, 0.012, MAPLE),))
    section = cue.section(0.0)
    s = 10 * section.EA / section.rhoA / cue.length**2
    exact = 1 / np.tanh(math.sqrt(10)) / np.sqrt(s * section.EA * section.rhoA) - 1 / (cue.mass * s)
    result = rod_modes(cue, tuple(cue.nodes), cutoff=cutoff, n_corrected=1)
    assert len(result.omega) == 2 + np.sum(result.omega[:-2] <= cutoff)
    assert np.sum(result.tip_displacement**2 / (result.omega**2 + s)) == pytest.approx(exact, rel=1e-6)
    truncated = rod_modes(cue, tuple(cue.nodes), cutoff=cutoff)
    assert truncated.radiation is None
    assert np.sum(truncated.tip_displacement**2 / (truncated.omega**2 + s)) < 0.95 * exact


def test_slow_waves_have_bounded_unknowns() -> None:
    """A butt of 100 m/s: 4000 rod modes lay below the cutoff of the end mass, which took minutes."""
    slow = cf.AxialWaves(cue_length=1.47, butt_diameter=0.03, wave_speed=100.0)
    scene = replace(cf.usual_scene(reference_cue("pool_maple")), effects=(slow,))
    tip = SolvedScene(scene).stick_tip
    assert 160 < len(tip.omega) < 340
    assert cf.strike(scene).squirt == pytest.approx(0.0354780, rel=1e-4)  # of 640 rod modes
