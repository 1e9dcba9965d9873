"""Properties of quantities: intervals, messages, what `check` lets through and what it keeps out."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cuefem.cue import Cue, Material, Segment
from cuefem.quantity import Number, Quantity, check_count, check_fields, check_kind, quantities, scalar
from cuefem.scene import Scene

SCENE = Scene(Cue((Segment(0.7, 0.012, 0.021, Material(12.6e9, 0.84e9, 782.0)),)))
INTERVALS = ["(0, inf)", "[0, inf)", "[0, inf]", "[0, 1]", "(-1, 1)", "(-inf, inf)"]


@given(st.sampled_from(INTERVALS), st.floats(allow_nan=False) | st.sampled_from([0.0, -0.0, 1.0, -1.0, math.inf]))
def test_holds_as_mathematics_means_it(interval: str, value: float) -> None:
    low, high = (float(end) for end in interval[1:-1].split(","))
    inside = low < value < high or (value == low and interval[0] == "[") or (value == high and interval[-1] == "]")
    assert bool(Quantity("m", interval).holds(value)) == inside


@pytest.mark.parametrize("interval", INTERVALS)
def test_nan_lies_nowhere(interval: str) -> None:
    with pytest.raises(ValueError, match="got nan"):
        Quantity("m", interval).check("x", math.nan)


@given(st.floats(1e-300, 1e300))
def test_numbers_pass_unchanged(value: float) -> None:
    length = Quantity("m", "(0, inf)")
    assert length.check("x", value) == value
    assert length.check("x", np.float64(value)) == value
    assert type(length.check("x", np.float64(value))) is float


def test_whole_numbers_and_empty_shapes_become_floats() -> None:
    length = Quantity("m", "(0, inf)")
    for value in (3, np.int64(3), np.array(3), np.float32(3)):
        checked = length.check("x", value)
        assert checked == 3.0
        assert type(checked) is float


def test_arrays_are_copied_and_locked() -> None:
    given_ = np.array([1.0, 2.0])
    checked = Quantity("m", "(0, inf)").check("x", given_)
    given_[0] = -1
    np.testing.assert_array_equal(checked, [1.0, 2.0])
    with pytest.raises(ValueError, match="read-only"):
        checked[0] = 5.0


@pytest.mark.parametrize(
    ("value", "kind", "message"),
    [
        (-1.0, ValueError, "x must be in (0, inf) m; got -1.0"),
        (math.inf, ValueError, "x must be in (0, inf) m; got inf"),
        (True, TypeError, "x must be a number in (0, inf) m; got True"),
        ("3 m", TypeError, "x must be a number in (0, inf) m; got '3 m'"),
        (None, TypeError, "x must be a number in (0, inf) m; got None"),
        (object, TypeError, "x must be a number in (0, inf) m; got <class 'object'>"),
        ([1.0, "a"], TypeError, "x must be a number in (0, inf) m; got [1.0, 'a']"),
        ([1.0, -2.0], ValueError, "x must be in (0, inf) m; got -2.0 at index 1"),
        ([[1.0, 2.0], [3.0, 0.0]], ValueError, "x must be in (0, inf) m; got 0.0 at index (1, 1)"),
    ],
)
def test_messages_say_name_bound_unit_value(value: object, kind: type[Exception], message: str) -> None:
    with pytest.raises(kind) as caught:
        Quantity("m", "(0, inf)").check("x", value)
    assert str(caught.value) == message


def test_a_pure_number_has_no_unit_in_messages() -> None:
    assert Quantity("", "[0, 1]").bounds == "[0, 1]"
    assert Quantity("kg", "[0, 1]").bounds == "[0, 1] kg"


def test_examples_carry_the_unit() -> None:
    assert Quantity("m").example == 'a length with its unit, such as "12 mm"'
    assert Quantity("K").example == 'a quantity with its unit, such as "3 K"'


@dataclass(frozen=True)
class Thing:
    size: Annotated[float, Quantity("m", "(0, inf)")]
    part: Annotated[float | None, Quantity("", "[0, 1]")] = None
    many: Annotated[Number, Quantity("kg", "(0, inf)")] = 1.0
    name: str = ""

    def __post_init__(self) -> None:
        check_fields(self)


def test_fields_are_found_and_checked() -> None:
    assert [(name, q.unit, optional) for name, q, optional, _ in quantities(Thing)] == [
        ("size", "m", False),
        ("part", "", True),
        ("many", "kg", False),
    ]
    thing = Thing(3)
    assert type(thing.size) is float
    assert thing.part is None
    with pytest.raises(ValueError, match=r"Thing\.part must be in \[0, 1\]; got 2"):
        Thing(1.0, 2)
    with pytest.raises(TypeError, match=r"Thing\.size must be a number in \(0, inf\) m; got None"):
        Thing(None)  # type: ignore[arg-type]


def test_scalar_refuses_arrays() -> None:
    assert scalar("x", 2.0) == 2.0
    with pytest.raises(ValueError, match=r"x must be one number; got an array of shape \(2,\)"):
        scalar("x", np.array([1.0, 2.0]))


def test_kinds_and_counts() -> None:
    check_kind("x", 3, (int, str))
    with pytest.raises(TypeError, match=r"x must be an int or str; got 2\.5"):
        check_kind("x", 2.5, (int, str))
    with pytest.raises(TypeError, match=r"^x must be a Cue; got a Scene: pass its cue$"):
        check_kind("x", SCENE, Cue)
    with pytest.raises(TypeError, match=r"^x must be a Cue; got a Ball$"):
        check_kind("x", SCENE.ball, Cue)
    with pytest.raises(TypeError, match=r"^x must be a Cue; got \[0, 1, 2, .*\.\.\.$"):
        check_kind("x", list(range(1000)), Cue)
    check_count("n", np.int64(4), 1)
    for wrong in (True, 2.0, "2", None):
        with pytest.raises(TypeError, match="n must be a whole number >= 1"):
            check_count("n", wrong, 1)
    with pytest.raises(ValueError, match="n must be a whole number >= 2; got 1"):
        check_count("n", 1, 2)
