"""Properties of files: what is saved loads back identical, and whatever is not read is clearly refused."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import Annotated, Any
from unittest import mock

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cuefem as cf
from cuefem.effects import Effect
from cuefem.io import InputError, schema
from cuefem.io.units import USUAL, number, quantity, scale_by_pint, text
from cuefem.quantity import EXAMPLES, Quantity, check_fields


@dataclass(frozen=True)
class Weight(Effect):
    """An effect made for these tests: text with units, a bare number, one that may be infinite, one left out."""

    position: Annotated[float, Quantity("m", "[0, inf)")]
    mass: Annotated[float, Quantity("kg", "[0, inf]")] = 0.0
    ratio: Annotated[float, Quantity("", "(-inf, inf]")] = math.inf
    inertia: Annotated[float | None, Quantity("kg m^2", "[0, inf)")] = None

    def __post_init__(self) -> None:
        check_fields(self)


MESHES = Path(__file__).parents[2] / "meshes"
POSITIVE = st.floats(0, math.inf, exclude_min=True, exclude_max=True)
SIZES = st.floats(1e-6, 10)
FINITE = st.floats(allow_nan=False, allow_infinity=False)


@st.composite
def materials(draw: Callable) -> cf.Material:
    E = draw(st.floats(1e-300, 1e300))
    return cf.Material(
        E, E * draw(st.floats(0.01, 0.5)), draw(POSITIVE), draw(st.floats(0, 0.99)), draw(st.floats(0, 0.5))
    )


@st.composite
def segments(draw: Callable) -> cf.Segment:
    tip, butt = draw(SIZES), draw(SIZES)
    bores = tip * draw(st.floats(0, 0.99)), butt * draw(st.floats(0, 0.99))
    core, kappa = draw(st.none() | materials()), draw(st.none() | st.floats(0.1, 1))
    return cf.Segment(draw(SIZES), tip, butt, draw(materials()), *bores, core, kappa)


CUES = st.builds(cf.Cue, st.lists(segments(), min_size=1, max_size=3), st.floats(0, 1e300))
LUMPED = st.builds(
    lambda mass, end_mass, part: cf.LumpedCue(mass, end_mass, part / math.sqrt(mass * end_mass)),
    *(SIZES, SIZES, st.floats(-0.9, 0.9)),
)
TIPS = st.builds(cf.Tip, st.floats(0, 1), st.floats(0, math.inf), st.none() | st.floats(1e-6, 10)) | st.builds(
    cf.Tip, st.floats(0, 1), stiffness=POSITIVE
)
WEIGHTS = st.builds(Weight, SIZES, st.floats(0, math.inf), st.floats(-1e9, math.inf), st.none() | POSITIVE)
SCENES = st.builds(
    cf.Scene,
    CUES | LUMPED,
    st.builds(cf.Ball, POSITIVE, POSITIVE, st.floats(0, 1, exclude_min=True)),
    TIPS,
    st.builds(cf.Stroke, POSITIVE, st.floats(-1, 1, exclude_min=True, exclude_max=True)),
    st.lists(WEIGHTS, max_size=2).map(tuple),
)


def outcome(read: Callable) -> tuple[Any, str]:
    """What ``read`` gives, or the words in which it refuses."""
    try:
        return read(), ""
    except ValueError as error:
        return None, str(error)


def saved_and_loaded(thing: cf.Cue | cf.Scene, name: str) -> cf.Cue | cf.Scene:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        cf.save(thing, path)
        assert [path] == list(Path(folder).iterdir())
        return cf.load(path)


ALL_BY_PYDANTIC = mock.patch.object(schema, "_plainly", side_effect=schema._Unclear)


@given(CUES | SCENES)
@settings(max_examples=100, deadline=None)
def test_toml_reads_back_exactly(thing: cf.Cue | cf.Scene) -> None:
    assert saved_and_loaded(thing, "thing.toml") == thing


@given(CUES | SCENES)
@settings(max_examples=30, deadline=None)
def test_pydantic_reads_the_same(thing: cf.Cue | cf.Scene) -> None:
    with ALL_BY_PYDANTIC:
        assert saved_and_loaded(thing, "thing.toml") == thing


def test_a_faultless_drawing_needs_no_pydantic() -> None:
    with mock.patch.object(schema, "build_by_pydantic", side_effect=AssertionError):
        for name in ("kim.toml", "pool_hollow.toml"):
            assert isinstance(cf.load(MESHES / name), cf.Cue)


@pytest.mark.parametrize("suffix", ["vtk", "vtu"])
@given(cue=CUES)
@settings(max_examples=40, deadline=None)
def test_meshes_read_back_exactly(suffix: str, cue: cf.Cue) -> None:
    assert saved_and_loaded(cue, f"cue.{suffix}") == cue


@given(FINITE, st.sampled_from(sorted(EXAMPLES)))
@settings(max_examples=300)
def test_every_number_is_written_so_that_it_reads_back(value: float, unit: str) -> None:
    assert number(text(value, unit), unit) == value


@pytest.mark.parametrize(("unit", "wanted"), [(unit, wanted) for wanted in USUAL for unit in USUAL[wanted]])
def test_the_usual_units_are_those_of_pint(unit: str, wanted: str) -> None:
    found, known = scale_by_pint(unit, wanted), Decimal(USUAL[wanted][unit])
    assert abs(found / known - 1) < Decimal("1e-25")  # pint 0.24 rounds the last of 28 digits in another way


def test_every_unit_that_is_written_is_a_usual_one() -> None:
    assert USUAL.keys() == EXAMPLES.keys()
    for unit, (_, example) in EXAMPLES.items():
        assert {unit, example.split(" ", 1)[1]} <= USUAL[unit].keys()


@pytest.mark.heavy
@given(st.text(max_size=30) | st.from_regex(r"[0-9.]{1,4} ?[a-zA-Z*/^0-9()]{0,12}", fullmatch=True))
@settings(max_examples=400, deadline=None)
def test_no_text_is_more_than_refused(given_text: str) -> None:
    wanted = Quantity("m", "(0, inf)")
    value, refusal = outcome(lambda: quantity(wanted, given_text))
    assert refusal.startswith("must be in (0, inf) m") if refusal else 0 < value < math.inf


@given(st.binary(max_size=80), st.sampled_from([".toml", ".csv", ".vtk", ".vtu"]))
@settings(max_examples=150, deadline=None)
def test_no_file_is_more_than_refused(content: bytes, suffix: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"file{suffix}"
        path.write_bytes(content)
        with pytest.raises(InputError) as caught:
            cf.load(path)
        assert len(str(caught.value).splitlines()) == 1


@given(data=st.data(), suffix=st.sampled_from([".toml", ".vtk", ".vtu"]))
@settings(max_examples=150, deadline=None)
def test_a_damaged_file_is_refused_or_read(data: st.DataObject, suffix: str) -> None:
    maple = cf.Material(12.6e9, 0.84e9, 782.0)
    cue = cf.Cue((cf.Segment(0.3, 0.012, 0.014, maple), cf.Segment(0.4, 0.014, 0.021, maple, core=maple)), 0.42)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"cue{suffix}"
        cf.save(cue, path)
        content = bytearray(path.read_bytes())
        first = data.draw(st.integers(0, len(content) - 1))
        content[first : first + data.draw(st.integers(0, 40))] = data.draw(st.binary(max_size=5))
        path.write_bytes(content)
        loaded, refusal = outcome(lambda: cf.load(path))
        assert refusal.startswith(f"{path}: ") if refusal else isinstance(loaded, cf.Cue)
        assert len(refusal.splitlines()) <= 1
        with ALL_BY_PYDANTIC:
            assert outcome(lambda: cf.load(path)) == (loaded, refusal)
