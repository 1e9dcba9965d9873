"""Quantities: intervals, error messages, fractions (properties)."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cuefem.cue import Material, Segment
from cuefem.quantity.display_units import US
from cuefem.quantity.fields import OutOfBounds, Quantity

INTERVALS = ["(0, inf)", "[0, inf)", "[0, inf]", "[0, 1]", "(-1, 1)", "(-inf, inf)"]


@given(st.sampled_from(INTERVALS), st.floats(allow_nan=False) | st.sampled_from([0.0, -0.0, 1.0, -1.0, math.inf]))
def test_quantity_interval_contains_its_numbers(interval: str, value: float) -> None:
    low, high = (float(end) for end in interval[1:-1].split(","))
    inside = low < value < high or (value == low and interval[0] == "[") or (value == high and interval[-1] == "]")
    assert bool(Quantity("m", interval).contains(value)) == inside


def test_field_integer_is_stored_as_float() -> None:
    assert type(Material(12_000_000_000, 840_000_000, 782).rho) is float


def test_dependent_bound_error_has_si_and_file_units() -> None:
    message = r"^Segment.tip_bore must be in \[0, 0.012\) m, its outer diameter; got 0.013"
    with pytest.raises(OutOfBounds, match=message) as error:
        Segment(0.7, 0.012, 0.021, Material(12.6e9, 0.84e9, 782.0), tip_bore=0.013)
    assert error.value.file_message == "must be at least 0 and less than 12 mm, its outer diameter; got 13 mm"


def test_display_unit_of_a_compliance_is_the_reciprocal_of_a_stiffness() -> None:
    assert US["m/N"].factor * US["N/m"].factor == pytest.approx(1.0, rel=1e-12)
