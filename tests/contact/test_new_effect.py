"""Properties: an effect that is defined here alone, and adds its terms, changes a strike; no module knows its name."""

import gc
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np
import pytest

from cuefem import Elevation, PowerLawTip, Resolution, RollingContact, SecondHit, TipDome, motion, strike
from cuefem.effects import TipEffect
from cuefem.effects.terms import ContactTerms
from cuefem.quantity.fields import Quantity, quantities
from cuefem.scene import Scene
from tests.helpers.strike_scenes import imbalance, kim_scene

AT = Resolution(3, 8, 8)


def lever_shift() -> type[TipEffect]:
    @dataclass(frozen=True)
    class TipLeverShift(TipEffect):
        """A made-up tip whose contact lies off the cue's axis by ``shift``, m, wherever it is struck."""

        shift: Annotated[float, Quantity("m")]

        def add_to_contact(self, terms: ContactTerms) -> None:
            """The lever."""
            terms.add_lever(lambda phi: (-self.shift, 0.0))

    return TipLeverShift


def soft_patch() -> type[TipEffect]:
    @dataclass(frozen=True)
    class SoftPatch(TipEffect):
        """A made-up tip that gives way sideways as much as along the normal."""

        def add_to_contact(self, terms: ContactTerms) -> None:
            """The compliance."""
            terms.add_compliance(1.0)

    return SoftPatch


def another_window() -> type[TipEffect]:
    @dataclass(frozen=True)
    class AnotherWindow(TipEffect):
        """A made-up effect that gives what may be given only once."""

        def add_to_contact(self, terms: ContactTerms) -> None:
            """A window."""
            terms.set_window(1e-3)

    return AnotherWindow


@pytest.fixture(autouse=True)
def forgotten():
    """The made-up effects are gone when a test is over: files and tables list every effect that there is."""
    yield
    quantities.cache_clear()
    gc.collect()
    assert {kind.__module__ for kind in TipEffect.__subclasses__()} == {"cuefem.effects.at_tip"}


def struck(*effects) -> Scene:
    return replace(kim_scene(0.4), effects=effects)


def test_a_made_up_lever_changes_a_strike_as_a_dome_of_that_lever_does():
    dome = TipDome(0.009)
    phi = float(np.arcsin(0.4))
    shift, back = dome.radius * np.sin(phi), dome.radius * (1 - np.cos(phi))
    assert strike(struck(lever_shift()(0.002)), AT).squirt != strike(struck(), AT).squirt
    terms = struck(dome, lever_shift()(-shift)).contact_terms
    assert terms.lever(phi) == pytest.approx((0.0, back), abs=1e-18)


def test_it_goes_with_the_others_in_any_order_and_however_it_is_split():
    others = (PowerLawTip(1.5), RollingContact(), TipDome(0.009))
    whole = strike(struck(lever_shift()(0.002), *others), AT)
    split = strike(struck(*others, lever_shift()(0.0005), lever_shift()(0.0015)), AT)
    assert imbalance(whole) < 1e-8
    assert split.squirt == pytest.approx(whole.squirt, rel=1e-9)


def test_it_is_seen_in_the_motion_and_in_the_bare_scene():
    scene = struck(lever_shift()(0.002))
    assert scene.bare == struck()
    moved, plain = (motion(s, [1e-3], AT).centre for s in (scene, scene.bare))
    assert np.abs(moved - plain).max() > 1e-9


def test_what_no_contact_honours_together_is_refused_by_its_terms():
    with pytest.raises(ValueError, match="takes a tip without give sideways, a fixed normal and a single"):
        strike(struck(soft_patch()(), Elevation(0.1)), AT)


def test_what_may_be_given_once_is_refused_the_second_time():
    with pytest.raises(ValueError, match=r"Scene\.effects must give the contact one window for a second hit; got"):
        struck(SecondHit(), another_window()())
