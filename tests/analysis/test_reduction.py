"""The chain from the drawing to squirt on [Kim]'s cone, its limits, and invalid input (verification)."""

import json
import math
import re
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

import cuefem as cf
from cuefem.analysis.reduction import SMALL_OFFSETS, VIBRATING, Reduction
from cuefem.endmass.rigid_front import RigidFront
from cuefem.show.renderers import json_text
from studies.pages import STUDIES
from studies.paper.closed_forms import cone_end_mass, inertia_factor, squirt_slope
from tests.helpers.command_line import call
from tests.helpers.cues import rod

KIM: Any = cf.load(STUDIES / "scenes" / "kim.toml")
LUMPED = replace(KIM, cue=cf.LumpedCue(0.54, 0.006))
AT_OFFSET = "this shaft, b/R 0.3"


def scaled(factor: float, *names: str) -> cf.Scene:
    """The scene of [Kim] with material constants of the shaft times a factor; the mass of the cue is the same."""
    (cone,) = KIM.cue.segments
    constants = {name: factor * getattr(cone.material, name) for name in names}
    shaft = replace(cone, material=replace(cone.material, **constants))
    return replace(KIM, cue=cf.Cue((shaft,), KIM.cue.mass - shaft.mass))


@cache
def kim_reduction() -> Reduction:
    return cf.reduction(KIM)


def test_reduction_of_kims_cone_has_the_numbers_of_the_chain() -> None:
    own = kim_reduction()
    assert [round(frequency) for frequency in own.frequencies] == [121, 325, 624, 1008]
    nearest = {name: (mode["mode"], round(mode["frequency"])) for name, mode in own.nearest.items()}
    assert nearest == {"free": (2, 325), "pinned": (2, 272), "clamped": (3, 338)}
    E = KIM.cue.segments[0].material.E
    assert round(own.nearest["pinned"]["stiffness_ratio"] * E / 1e9, 1) == 10.6
    rows = {
        name: (
            *(model[key] and round(1e3 * model[key], 2) for key in ("end_mass", "cue_end_mass")),
            model["eps"] and round(model["eps"], 3),
            [round(math.degrees(squirt), 2) for squirt in model["squirt"]],
        )
        for name, model in own.models.items()
    }
    assert rows == {
        "Kim's guess": (3.00, 12.00, 0.057, [0.24, 0.73, 1.23]),
        SMALL_OFFSETS: (8.09, 32.37, 0.154, [0.60, 1.82, 3.07]),
        AT_OFFSET: (6.87, 27.47, 0.131, [0.52, 1.57, 2.66]),
        VIBRATING: (None, None, None, [0.59, 1.62, 2.42]),
    }


def test_reduction_equals_its_public_parts() -> None:
    own = cf.reduction(KIM, offsets=(0.3, -0.5))
    assert own.models[SMALL_OFFSETS]["end_mass"] == cf.end_mass(KIM)
    assert own.models[AT_OFFSET]["end_mass"] == cf.end_mass(KIM, "offset")
    assert own.models[AT_OFFSET]["squirt"][0] == pytest.approx(cf.impulse(KIM).squirt, rel=1e-12)
    assert own.models[VIBRATING]["squirt"] == pytest.approx(
        [cf.strike(replace(KIM, stroke=replace(KIM.stroke, offset=b))).squirt for b in (0.3, -0.5)], rel=1e-12
    )
    by_time = {row["contact_time"]: row for row in own.end_mass_by_contact_time}
    assert by_time[2e-3]["stick"] == pytest.approx(cf.end_mass(KIM), rel=1e-12)
    short = replace(KIM, tip=replace(KIM.tip, contact_time=1e-3))
    assert by_time[1e-3]["offset"] == pytest.approx(cf.end_mass(short, "offset"), rel=1e-12)
    curves = own.squirt_curves()
    assert curves[VIBRATING][own.chart_offsets.index(0.3)] == own.models[VIBRATING]["squirt"][0]


def test_rigid_front_equals_closed_forms_of_kims_cue_end() -> None:
    shaft = {"length": 0.7, "tip_radius": 6e-3, "butt_radius": 10.5e-3}
    front = RigidFront.of(KIM.cue)
    base = 6e-3 + 4.5e-3 * 0.12 / 0.7
    nu_c = float(inertia_factor(tip_radius=6e-3, base_radius=base, end_length=0.12))
    mass = float(cone_end_mass(0.12, shaft_mass=KIM.cue.shaft_mass, **shaft))
    assert front.mass_ratio(0.12) == pytest.approx((1 + nu_c) / nu_c, rel=2e-5)
    assert front.length_of(mass * nu_c / (1 + nu_c)) == pytest.approx(0.12, rel=2e-5)
    assert kim_reduction().front_ratio == pytest.approx(4.23, abs=5e-3)
    thin = rod(1000.0)
    assert RigidFront.of(thin).length_of(thin.shaft_mass / 4) == pytest.approx(thin.length, rel=2e-5)
    assert front.length_of(1.0) is None


def test_reduced_squirt_of_light_cue_converges_to_first_order_in_eps() -> None:
    """Order 1 in eps: [Kim] eq. psi squirt."""
    errors = []
    for factor in (1e-1, 1e-2, 1e-3):
        scene = scaled(factor, "E", "G", "rho")
        own = cf.reduction(scene)
        slope = squirt_slope(0.3, cue_mass_ratio=scene.axial_mass / scene.ball.mass, nu_c=own.nu_c)
        model = own.models[AT_OFFSET]
        errors.append(abs(model["squirt"][1] / (float(slope) * model["eps"]) - 1))
    orders = [math.log10(coarse / fine) for coarse, fine in pairwise(errors)]
    assert orders == pytest.approx([1.0, 1.0], abs=0.02)
    assert errors[-1] < 2e-4


@pytest.mark.heavy
def test_vibrating_squirt_of_stiff_shaft_converges_to_rigid_cue_end() -> None:
    """The error oscillates: the largest in each decade of E. Its order, 1/T^2: studies/paper/convergence."""
    rigid = 4 * float(RigidFront.of(KIM.cue).end_mass[-1])

    def error(factor: float) -> float:
        models = cf.reduction(scaled(factor, "E", "G"), cue_ends={"rigid": rigid}, offsets=[0.3]).models
        return abs(models[VIBRATING]["squirt"][0] / models["rigid"]["squirt"][0] - 1)

    errors = [max(error(10 ** (decade + step)) for step in (0.0, 0.2, 0.4, 0.6, 0.8)) for decade in (2, 3, 4)]
    assert all(stiff < soft / 2 for soft, stiff in pairwise(errors))
    assert errors[-1] < 0.015


def test_lumped_cue_has_the_row_of_its_own_end_mass() -> None:
    own = cf.reduction(LUMPED)
    assert [*own.models] == ["this cue"]
    assert (own.frequencies, own.nearest, own.end_mass_by_contact_time) == ([], {}, [])
    squirt = cf.impulse(replace(LUMPED, stroke=replace(LUMPED.stroke, offset=0.1))).squirt
    assert own.models["this cue"]["squirt"][0] == pytest.approx(squirt, rel=1e-12)
    assert [*cf.reduction(LUMPED, cue_ends={"12 g": 0.012}).models] == ["12 g", "this cue"]


def test_head_on_stroke_has_the_offsets_of_the_table() -> None:
    own = cf.reduction(replace(KIM, stroke=cf.Stroke(1.0, 0.0)))
    assert [*own.models] == ["Kim's guess", SMALL_OFFSETS, VIBRATING]
    assert own.models[VIBRATING]["squirt"] == pytest.approx(kim_reduction().models[VIBRATING]["squirt"], rel=1e-9)


def test_miscue_has_no_squirt() -> None:
    own = cf.reduction(replace(KIM, tip=replace(KIM.tip, friction=0.1)))
    model = own.models[VIBRATING]
    assert (model["regime"][-1], model["squirt"][-1]) == ("miscue", None)
    assert "–" in own.tables()[1].rows[-1]


def test_leather_states_that_its_end_mass_is_for_the_impulse_solver() -> None:
    own = cf.reduction(cf.usual_scene(cf.load(STUDIES.parent / "meshes" / "pool_maple.toml")))
    assert {model["rigid_length"] for model in own.models.values()} == {None}
    assert any("for the impulse solver, and for programs" in note for note in own.tables()[1].notes)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"near": 0.0}, "reduction near must be in (0, inf) Hz; got 0.0"),
        ({"cue_ends": {"mine": -0.01}}, "reduction cue_ends['mine'] must be in (0, 0.54] kg; got -0.01"),
        ({"cue_ends": {"mine": 0.6}}, "reduction cue_ends['mine'] must be in (0, 0.54] kg; got 0.6"),
        ({"offsets": (0.1, 1.0)}, "Stroke.offset must be in (-1, 1); got 1.0"),
        ({"offsets": ()}, "reduction offsets must be at least one b/R between -1 and 1; got none"),
    ],
)
def test_invalid_input_names_item_bound_and_value(options: Any, message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        cf.reduction(KIM, **options)


def test_commands_state_the_numbers_of_the_call() -> None:
    expected = json.loads(json_text(kim_reduction().values()))
    for command in ("end-mass", "report"):
        status, out, _ = call(command, "--json", STUDIES / "scenes" / "kim.toml")
        assert status == 0
        assert json.loads(out)["reduction"] == expected
    shown = call("end-mass", STUDIES / "scenes" / "kim.toml")[1].splitlines()
    (row,) = (line.split() for line in shown if line.strip().startswith("this shaft, vibrating"))
    assert row[-3:] == ["0.59°", "1.62°", "2.42°"]


def test_end_mass_command_compares_typed_guesses() -> None:
    _, out, _ = call("end-mass", "--json", "--near", 300, "--cue-end", "15 g", STUDIES / "scenes" / "kim.toml")
    shown = json.loads(out)["reduction"]
    expected = cf.reduction(KIM, near=300.0, cue_ends={"Kim's guess": 0.012, "two-part, m_c 15 g": 0.015})
    assert shown == json.loads(json_text(expected.values()))


def test_analysis_prints_and_saves_itself(tmp_path: Path) -> None:
    own = kim_reduction()
    assert "this shaft, vibrating" in str(own)
    own.save(tmp_path / "own.json")
    own.save(tmp_path / "own.html")
    assert json.loads((tmp_path / "own.json").read_text("utf-8"))["models"]["Kim's guess"]["end_mass"] == 0.003
    assert "Effective end mass" in (tmp_path / "own.html").read_text("utf-8")
