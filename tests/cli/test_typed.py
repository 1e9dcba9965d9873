"""What people type on the command line: lengths for offsets, commas, other games, options that have no say
(properties)."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.helpers.command_line import call

KIM = Path(__file__).parents[2] / "meshes" / "kim.toml"
RADIUS = {"pool": 28.575, "carom": 30.75}  # mm


@pytest.mark.parametrize(("game", "radius"), RADIUS.items())
@pytest.mark.parametrize(("typed", "mm"), [("8 mm", 8.0), ("-0.25 in", -6.35), ("1 cm", 10.0)])
def test_an_offset_is_a_length_over_the_radius_of_the_ball(game: str, radius: float, typed: str, mm: float) -> None:
    status, out, err = call("strike", KIM, "--game", game, "--offset", typed, "--json")
    assert (status, err) == (0, "")
    assert json.loads(out)["scene"]["stroke"]["offset"] == pytest.approx(mm / radius, rel=1e-12)


WEIGH = [*("weigh", "--ball-mass", "8 g", "--before", "200 mm", "--after", "-34 mm", "--held-after", "162 mm")]
WEIGH += ["--thread", "1 m", "--contact-time", "1 ms"]


def test_the_offset_of_a_weighed_end_is_one_too() -> None:
    told = [json.loads(call(*WEIGH, "--json", "--offset", each)[1]) for each in ("8.5725 mm", "0.3")]
    assert told[0]["assumed"] == told[1]["assumed"]
    assert told[0]["lumped_squirt"] == pytest.approx(told[1]["lumped_squirt"], rel=1e-12)


def test_the_papers_own_end_mass_is_shown_where_it_is_asked_for() -> None:
    plain, paper = (" ".join(call("end-mass", KIM, *more)[1].split()) for more in ((), ("--paper",)))
    assert "m_c" not in plain
    assert "eps" not in plain
    assert "m_c = 4 m_e: cue end of the paper's two-part cue" in paper
    assert "eps: m_c as a part of the ball's mass" in paper


LENGTH = 'b/R, or a length such as "8 mm"'
REFUSED = [
    (["strike", KIM, "--offset", "0,3"], f"between -1 and 1, {LENGTH}; got '0,3'; a decimal point, no comma"),
    (["strike", KIM, "--offset", "8"], "--offset: must be between -1 and 1; got 8.0"),
    (["strike", KIM, "--offset", "8 kg"], LENGTH + "; got '8 kg'"),
    (
        ["strike", KIM, "--offset", "40 mm"],
        "1, or a length of less than 28.575 mm, the radius of the ball; got '40 mm'",
    ),
    (["strike", KIM, "--friction", "0,6"], "bare number, 0 or more; got '0,6'; a decimal point, no comma"),
    (["report", KIM, "--ball", "chess"], "'chess' is not one of 'pool', 'carom', 'snooker' (`"),
    (["strike", KIM, "--offset"], "Option '--offset' requires an argument"),
    (["strike", KIM, "--speed", "1e400"], "a number that is not so large, with its unit; got 1e400"),
    (["strike", KIM, "--body-mass", "15"], '--body-mass: needs a unit: "15 oz" or "425 g"; got \'15\''),
    (["strike", KIM, "--body-mass", "1e400 oz"], "a number that is not so large; got 1e400 oz"),
    (["strike", KIM, "--tip-height", "60 mm"], " mm high; got 60 mm (--tip-height, --dome, --contact-time change it)"),
    (["--frog"], "--frog"),
    (["side", KIM, "--contact-time", "10 s"], "--contact-time: must be 1e-6 to 0.5 s; got 10 s"),
    ([*WEIGH, "--material", "ash"], "--material: must go with --scene, whose shape it is for; got no --scene"),
    ([*WEIGH, "--length-unit", "in"], "--length-unit: must go with --scene, whose shape it is for; got no --scene"),
]


@pytest.mark.parametrize(("arguments", "words"), REFUSED, ids=[words[-25:] for _, words in REFUSED])
def test_what_cannot_be_meant_is_refused_in_one_line(arguments: list[object], words: str) -> None:
    status, out, err = call(*arguments)
    assert (status, out) == (2, "")
    (line,) = err.splitlines()
    assert line.startswith("cuefem: ")
    assert words in line
