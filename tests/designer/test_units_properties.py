"""Numbers as people type them, in millimetres or inches (properties)."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cuefem.designer.unit_system import INCHES, METRIC, typed
from cuefem.results.quantities import RESULTS

TYPED = {
    ("11,8", "mm"): 11.8,
    ("11.8", "mm"): 11.8,
    (" 11.80 ", "mm"): 11.8,
    ("11", "mm"): 11.0,
    (",5", "ms"): 0.5,
    ("11,", "mm"): 11.0,
    ("-3", ""): -3.0,
    ("−3", ""): -3.0,
    ("29/64", "in"): 29 / 64,
    ("29/64 Inches", "in"): 29 / 64,
    ("500 thou", "mm"): 12.7,
    ("1 1/8", "in"): 1.125,
    ("1-1/8 in", "in"): 1.125,
    ('1/2"', "in"): 0.5,
    ("1/2 inch", "mm"): 12.7,
    ("12 mm", "mm"): 12.0,
    ("12mm", "mm"): 12.0,
    ("12,7 mm", "in"): 0.5,
    ("19 oz", "g"): 19 * 28.349523125,
}
NO_NUMBER = "must be a number, such as 11.8 or 11,8"
REFUSED = {
    **{(text, "mm"): NO_NUMBER for text in ("1e-3", "1,234.5", "1.234,5", "twelve", "", "9" * 50)},
    ("1/0", "in"): "must be a number, such as 29/64; got a division by 0",
    ("1e400", "in"): f"{NO_NUMBER}: no unit is called 'e400'",
    ("12 g", "mm"): "must be a length, in mm or a unit of its own; got a mass",
    ("12 furlongs", "mm"): "no unit is called 'furlongs'",
    ("0.3 mm", ""): "must be a bare number, without a unit",
}


def test_a_number_is_taken_as_it_is_typed() -> None:
    assert {(text, unit): typed(text, unit) for text, unit in TYPED} == pytest.approx(TYPED, rel=1e-15)


@pytest.mark.parametrize(("text", "unit"), REFUSED)
def test_what_is_no_number_is_refused_in_words(text: str, unit: str) -> None:
    with pytest.raises(ValueError, match=re.escape(REFUSED[text, unit])):
        typed(text, unit)


@given(st.floats(0.001, 2))
def test_both_systems_write_the_same_length_and_mass(value: float) -> None:
    for name, unit, most in (("length", "m", 0.5e-3), ("radius", "m", 0.005e-3), ("mass", "kg", 1e-3 * value)):
        known = RESULTS[name]
        for system in (METRIC, INCHES):
            scale, _ = system.units[unit]
            number, shown_unit = known.written(value, units=system.units).split(" ")
            assert float(number) / scale == pytest.approx(value, abs=1.01 * most)
            assert typed(number, shown_unit) == float(number)


SAID = {
    "736.6 mm modelled in 5 segments, cue 567 g; E 12.6 GPa, 3.5 g/cm, squirt 1.2°, 2 to 40 mm, 0.7 m": (
        "29.00 in modelled in 5 segments, cue 20.00 oz; E 12.6 GPa, 3.5 g/cm, squirt 1.2°, 0.07874 to 1.575 in, 0.7 m"
    ),
    "bore wider, 6.35 → 12.7 mm": "bore wider, 0.2500 → 0.5000 in",
    "a bore, 6.35 mm wide and 127 mm deep": "a bore, 0.2500 in wide and 5.000 in deep",
    "−2.835\u00a0g": "−0.1000\u00a0oz",
    "5.8 to 14 g": "0.2046 to 0.4938 oz",
    "squirt 1.8°, 12.9 Hz": "squirt 1.8°, 12.9 Hz",
}


def test_sentences_are_said_in_the_units_in_use() -> None:
    assert {metric: INCHES.said(metric) for metric in SAID} == SAID
    assert all(METRIC.said(metric) is metric for metric in SAID)
