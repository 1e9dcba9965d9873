"""Invalid values of every declared field raise an error with name and bound, in Python and in files (properties).

In Python: out of bounds, nan and wrong type; in a file also missing unit, wrong unit, misspelt key and missing key.
"""

import copy
import math
from collections.abc import Iterator
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomlkit

import cuefem as cf
from cuefem.effects.effect import effect_kinds
from cuefem.files import InputError
from cuefem.files.schema import field_types, required_keys
from cuefem.quantity.fields import Quantity, quantity_fields, quantity_of

WOOD = cf.Material(12.6e9, 0.84e9, 700.0)
LEATHER = cf.LeatherTip(6e-3, 9.5e-3, 140e6)
# An instance of each class with declared fields.
INSTANCES: list[Any] = [
    *(WOOD, cf.Segment(0.7, 0.012, 0.021, WOOD), cf.Ball(), cf.Tip(), cf.Stroke()),
    *(
        cf.LumpedCue(0.54, 0.01),
        cf.PointMass(position=0.1, mass=0.01),
        cf.Support(0.1, 1e3),
        cf.Joint(0.1, 1e-3),
        LEATHER,
    ),
    cf.AxialWaves(1.47, 0.03, 4430.0),
    *(cf.TipDome(0.01), cf.TipShear(0.75), cf.Elevation(0.1), cf.TipLayer(1e-3, 1e9)),
    *(cf.StructuralDamping(0.01), cf.PowerLawTip(), cf.SecondHit(), cf.Striker(0.02, 0.8, contact_time=1e-3)),
]


def beyond(mark: Quantity) -> Iterator[float]:
    """Numbers outside an interval."""
    yield math.nan
    for end, side, bracket in zip(mark.ends, (-1, 1), (mark.interval[0], mark.interval[-1]), strict=True):
        if math.isfinite(end):
            yield end + side * max(1e-7, 1e-7 * abs(end))
        if bracket in "()":
            yield end


@pytest.mark.parametrize("instance", INSTANCES, ids=lambda instance: type(instance).__name__)
def test_field_invalid_value_in_python_raises(instance: Any) -> None:
    kind = type(instance)
    for name, mark, optional in quantity_fields(kind):
        prefix = f"{kind.__name__}.{name} must be "
        for wrong in beyond(mark):
            with pytest.raises(ValueError, match=r"must be in") as error:
                replace(instance, **{name: wrong})
            assert str(error.value).startswith(f"{prefix}in "), name
        for wrong in ("0.5", True, {}, np.full(2, 0.5), *([] if optional else [None])):
            with pytest.raises(TypeError) as raised:
                replace(instance, **{name: wrong})
            assert str(raised.value).startswith(f"{prefix}a number in {mark.bounds}; got "), name


def test_instances_cover_every_effect() -> None:
    covered = {type(instance).__name__ for instance in INSTANCES}
    kinds = {name: kind for name, kind in effect_kinds().items() if kind.__module__.startswith("cuefem.")}
    assert {name for name, kind in kinds.items() if fields(kind)} <= covered


SCENE = cf.Scene(
    cf.Cue((cf.Segment(0.7, 0.012, 0.021, WOOD, tip_bore=0.003),), 0.42),
    tip=cf.Tip(contact_time=1e-3),
    effects=(cf.PointMass(position=0.1, mass=5e-3),),
)
TABLES = {
    "cue.segments[0].material": cf.Material,
    "cue.segments[0]": cf.Segment,
    "cue": cf.Cue,
    "ball": cf.Ball,
    "tip": cf.Tip,
    "stroke": cf.Stroke,
    "effects[0]": cf.PointMass,
}


def in_a_file(mark: Quantity) -> Iterator[tuple[Any, str]]:
    """Invalid values in a file, each with a part of its error message."""
    for end, side in zip(mark.ends, (-1, 1), strict=True):
        if math.isfinite(end):
            wrong = end + side * max(1.0, abs(end))
            yield (f"{wrong} {mark.unit}" if mark.unit else wrong), f"{end:.6g}".replace("e-0", "e-")
    yield "inf mm" if mark.unit == "m" else [], "must be "
    if mark.unit:
        yield "700", "needs a unit: "
        yield "1 V", "unknown unit 'V'"
        yield "3 s" if mark.unit != "s" else "3 g", "must be "


@pytest.mark.parametrize("key", TABLES)
def test_field_invalid_value_in_file_raises(tmp_path: Path, key: str) -> None:
    path, kind = tmp_path / "scene.toml", TABLES[key]
    cf.save(SCENE, path)
    stored = tomlkit.parse(path.read_text()).unwrap()

    def error_line(name: str, value: Any) -> str:
        scene: Any = copy.deepcopy(stored)
        table = scene
        for part in key.replace("[0]", ".0").split("."):
            table = table[int(part) if part.isdecimal() else part]
        table.pop(name, None) if value is None else table.update({name: value})
        path.write_text(tomlkit.dumps(scene))
        with pytest.raises(InputError) as error:
            cf.load(path)
        line = str(error.value)
        assert line.startswith(f"{path}: ")
        assert "\n" not in line
        return line.removeprefix(f"{path}: ")

    for name, hint in field_types(kind).items():
        mark = quantity_of(hint)
        for value, message in in_a_file(mark) if mark else [(3, "must be ")]:
            line = error_line(name, value)
            assert line.startswith(f"{key}.{name}: "), line
            assert message in line, line
        line = error_line(f"{name}x", 1)
        assert line.startswith(f"{key}.{name}x: unknown key; did you mean "), line
        assert len(name) < 4 or line.endswith(f"; did you mean '{name}'?"), line
        if name in required_keys(kind):
            assert error_line(name, None).startswith(f"{key}.{name}: must be given, ")
