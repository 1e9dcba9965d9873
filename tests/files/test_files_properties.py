"""Files: saved objects load equal, units, arbitrary content (properties)."""

import math
import tempfile
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import Annotated, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import constants

import cuefem as cf
from cuefem.effects.effect import Effect
from cuefem.files import InputError
from cuefem.quantity.fields import Quantity, check_fields
from cuefem.quantity.units import EXAMPLES, UNITS, format_number, parse_number
from tests.helpers.examples import examples


@dataclass(frozen=True)
class Weight(Effect):
    """An effect with a quantity, an optional one, one that may be infinite, and a bare number."""

    position: Annotated[float, Quantity("m", "[0, inf)")]
    mass: Annotated[float, Quantity("kg", "[0, inf]")] = 0.0
    ratio: Annotated[float, Quantity("", "(-inf, inf]")] = math.inf
    inertia: Annotated[float | None, Quantity("kg m^2", "[0, inf)")] = None

    def __post_init__(self) -> None:
        check_fields(self)


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


@given(CUES | SCENES)
@examples(25)
def test_save_and_load_preserve_twelve_digits(item: cf.Cue | cf.Scene) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "thing.toml"
        cf.save(item, path)
        assert [path] == list(Path(folder).iterdir())
        assert_close(cf.load(path), item)


def assert_close(result: Any, expected: Any) -> None:
    """Numbers are equal to 2e-12, everything else exactly."""
    assert type(result) is type(expected)
    if is_dataclass(expected):
        for field in (field for field in fields(expected) if field.compare):
            assert_close(getattr(result, field.name), getattr(expected, field.name))
    elif isinstance(expected, tuple):
        for one, other in zip(result, expected, strict=True):
            assert_close(one, other)
    else:
        assert result == expected or result == pytest.approx(expected, rel=2e-12, abs=0)


@given(FINITE, st.sampled_from(sorted(EXAMPLES)))
@examples(200)
def test_formatted_number_reads_back(value: float, unit: str) -> None:
    assert parse_number(format_number(value, unit), unit) == pytest.approx(value, rel=2e-12, abs=0)


# Units as typed, and their size in SI by scipy.constants.
TYPED: dict[str, dict[str, float]] = defaultdict(dict)
for row in """
m: mm, millimetres, MM = milli; cm, centimeter = centi; m, meters = 1.0; in, inch, inches, IN, ", ″ = inch
m: thou, mil, mils = mil; ft, foot, feet = foot; um, µm, μm, micron = micron; yd = yard; km = kilo; mile = mile
kg: g, gram, grams = gram; oz, ounce, ounces, Oz = oz; lb, lbs, pounds = lb; kg, Kg, kilograms = 1.0; mg = 1e-06
kg: grains = grain; tonne = metric_ton
s: ms = 0.001; us = 1e-06; µs = 1e-06; sec = 1.0; min = minute; hours = hour
m/s: mph, mile/h = mph; km/h, kph, kmh = kmh; knot, knots, kt = knot; ft/s, fps = foot; in/s = inch
Pa: psi, lbf/in^2, PSI = psi; N/mm^2, N/mm², MPa = mega; ksi = 1000.0*psi; Msi = 1000000.0*psi; kgf/cm2 = 10000.0*kgf
Pa: bar = bar; GPa = giga; kPa = kilo; Pa = 1.0
kg/m^3: g/cc, g/cm^3, g/cm3, g/cm**3, g/ml, kg/l = 1000.0; lb/ft^3 = lb/foot**3; lb/in3 = lb/inch**3
N/m: N/mm, kN/m = 1000.0; lbf/in = lbf/inch; kgf/mm = 1000.0*kgf
N m/rad: N m/rad, N*m/rad, N·m/rad, N m = 1.0; N mm/deg = 0.001/degree; lbf in/rad = lbf*inch
rad/(N m): rad/(N m) = 1.0; deg/(N*mm) = 1000.0*degree; 1/(N m) = 1.0; rad/N/m = 1.0
m/N: mm/N = 0.001; in/lbf = inch/lbf
N m: N mm = 0.001; lbf ft = lbf*foot; ozf in = lbf*inch/16
N s/m: N s/mm = 1000.0; kg/s = 1.0
kg m^2: g mm^2 = 1e-09; g mm2 = 1e-09; g cm² = 1e-07; lb in^2 = lb*inch**2
rad: deg, degree, degrees, ° = degree; mrad = 0.001; rad = 1.0; arcmin = arcmin; arcsec = arcsec
N: N, newton = 1.0; kgf, kp = kgf; kN = 1000.0; gf = kgf/1000.0; lbf = lbf; ozf = lbf/16
m^3: cc, ml, mL = 1e-06; litres = liter
Hz: Hz, hz, Hertz = 1.0; kHz = 1000.0; MHz = 1000000.0; 1/s = 1.0; 1/min = 1/60
1/kg: 1/kg = 1.0; 1/g = 1000.0; 1/oz = 1/oz
""".strip().splitlines():
    unit, sizes = row.split(": ")
    for names, size in (part.rsplit(" = ", 1) for part in sizes.split("; ")):
        TYPED[unit] |= dict.fromkeys(names.split(", "), float(eval(size, vars(constants))))


@pytest.mark.parametrize("si_unit", TYPED)
def test_typed_quantity_equals_reference(si_unit: str) -> None:
    for unit, size in TYPED[si_unit].items():
        assert parse_number(f"1 {unit}", si_unit) == pytest.approx(size, rel=1e-15), unit
        assert unit[0] == "1" or parse_number(f"1{unit}", si_unit) == parse_number(f"1 {unit}", si_unit)


def test_reference_quantities_cover_every_unit() -> None:
    assert {UNITS[name] for units in TYPED.values() for name in units if name in UNITS} == {*UNITS.values()}


def test_written_units_are_known() -> None:
    assert EXAMPLES.keys() <= TYPED.keys()
    for unit, (_, example, *_) in EXAMPLES.items():
        assert parse_number(f"1 {example.split(' ', 1)[1]}", unit) > 0


@given(st.binary(max_size=80), st.sampled_from([".toml", ".csv", ".ply"]))
@examples(80)
def test_load_any_bytes_loads_or_is_rejected(content: bytes, suffix: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"file{suffix}"
        path.write_bytes(content)
        with pytest.raises(InputError) as caught:
            cf.load(path)
        assert len(str(caught.value).splitlines()) == 1


@given(data=st.data())
@examples(50)
def test_load_damaged_file_loads_or_is_rejected(data: st.DataObject) -> None:
    maple = cf.Material(12.6e9, 0.84e9, 782.0)
    cue = cf.Cue((cf.Segment(0.3, 0.012, 0.014, maple), cf.Segment(0.4, 0.014, 0.021, maple, core=maple)), 0.42)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cue.toml"
        cf.save(cue, path)
        content = bytearray(path.read_bytes())
        first = data.draw(st.integers(0, len(content) - 1))
        content[first : first + data.draw(st.integers(0, 40))] = data.draw(st.binary(max_size=5))
        path.write_bytes(content)
        error = f"{path}: none"
        try:
            assert isinstance(cf.load(path), cf.Cue)
        except InputError as caught:
            error = str(caught)
        assert error.startswith(f"{path}: ")
        assert len(error.splitlines()) == 1
