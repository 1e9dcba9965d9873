"""Quantities: intervals, error messages, fractions (properties)."""

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cuefem.cue import Material, Segment
from cuefem.quantity.fields import OutOfBounds, Quantity
from cuefem.quantity.units import parse_number

INTERVALS = ["(0, inf)", "[0, inf)", "[0, inf]", "[0, 1]", "(-1, 1)", "(-inf, inf)"]


@given(st.sampled_from(INTERVALS), st.floats(allow_nan=False) | st.sampled_from([0.0, -0.0, 1.0, -1.0, math.inf]))
def test_quantity_interval_contains_its_numbers(interval: str, value: float) -> None:
    low, high = (float(end) for end in interval[1:-1].split(","))
    inside = low < value < high or (value == low and interval[0] == "[") or (value == high and interval[-1] == "]")
    assert bool(Quantity("m", interval).contains(value)) == inside


def test_field_integer_is_stored_as_float() -> None:
    assert type(Material(12_000_000_000, 840_000_000, 782).rho) is float


MASS, SIZE = Quantity("kg", "[0, inf)"), Quantity("m", "(0, 10]")
# Invalid values of a file or an option, and the end of the error message.
READ = [
    (MASS, "15", 'needs a unit: "150 g" or "15 oz"; got \'15\''),
    (MASS, 15, 'needs a unit: "150 g" or "15 oz"; got 15'),
    (MASS, "-1 oz", "must be 0 oz or more; got -1 oz"),
    (MASS, "15 onces", "got '15 onces': unknown unit 'onces'; did you mean 'ounces'?"),
    (MASS, "15 mm", "must be a mass with its unit, such as \"150 g\"; got '15 mm', which is a length"),
    (MASS, "15,5 oz", "got '15,5 oz'; use a decimal point"),
    (MASS, "1e400 g", "must be 0 g or more; got 1e400 g"),
    (SIZE, "mm", "must be a length with its unit, such as \"12 mm\"; got 'mm'"),
    (SIZE, "1e-999 mm", "must be more than 0 and at most 10000 mm; got 1e-999 mm"),
    (MASS, "nan g", "must be 0 g or more; got nan g"),
    (MASS, True, 'must be a mass with its unit, such as "150 g"; got True'),
    (SIZE, "28 xyz", "unknown unit 'xyz'; valid: mm, m, cm, in, ft, thou, um, yd, km, mile"),
    (SIZE, "0 in", "must be more than 0 and at most 393.701 in; got 0 in"),
    (SIZE, "2e9 um", "must be more than 0 and at most 10 m; got 2e9 um"),
    (Quantity("s", "[1e-6, 10]"), "-2 ms", "must be 0.001 to 10000 ms; got -2 ms"),
    (Quantity("rad", "[0, 1.5707963267948966)"), "95°", "must be at least 0 and less than 90 °; got 95 °"),
    (Quantity("", "(-1, 1)"), 1.5, "must be between -1 and 1; got 1.5"),
    (Quantity("", "(-1, 1)"), "0.3", "must be a bare number, between -1 and 1; got '0.3'"),
    (Quantity("1/kg"), "nan 1/g", "must be a finite number of 1/g; got nan 1/g"),
    (Quantity("m", "(0, inf]", (("dime", 0.009),)), "9.5", 'needs a unit: "12 mm" or "0.5 in", or "dime"; got \'9.5\''),
]


@pytest.mark.parametrize(("quantity", "value", "message"), READ)
def test_read_invalid_value_raises_in_units_of_file(quantity: Quantity, value: object, message: str) -> None:
    with pytest.raises(ValueError, match=f"{re.escape(message)}$"):
        quantity.read(value)


def test_dependent_bound_error_has_si_and_file_units() -> None:
    message = r"^Segment.tip_bore must be in \[0, 0.012\) m, its outer diameter; got 0.013"
    with pytest.raises(OutOfBounds, match=message) as error:
        Segment(0.7, 0.012, 0.021, Material(12.6e9, 0.84e9, 782.0), tip_bore=0.013)
    assert error.value.file_message == "must be at least 0 and less than 12 mm, its outer diameter; got 13 mm"


@pytest.mark.parametrize(("text", "inches"), [("5/16 in", 0.3125), ("1 1/4 in", 1.25), ('29 1/2"', 29.5)])
def test_fraction_is_parsed(text: str, inches: float) -> None:
    assert parse_number(text, "m") == pytest.approx(25.4e-3 * inches, rel=1e-15)
    with pytest.raises(ValueError, match="needs a unit"):
        Quantity("m").read(text.rstrip('in" '))
