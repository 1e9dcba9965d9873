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


def made_up() -> type[TipEffect]:
    """The class of an effect that lies in no file of cuefem; inside, so that it is gone when a test is over."""

    @dataclass(frozen=True)
    class MadeUp(TipEffect):
        """A made-up tip whose contact lies off the cue's axis by ``shift``, m, and more if it is asked for."""

        shift: Annotated[float, Quantity("m")]
        give: float = 0.0
        window: float = 0.0

        def add_to_contact(self, terms: ContactTerms) -> None:
            """A lever; a compliance sideways, as a part of that along the normal; a window for a second hit."""
            terms.add_lever(lambda phi: (-self.shift, 0.0))
            if self.give:
                terms.add_compliance(self.give)
            if self.window:
                terms.set_window(self.window)

    return MadeUp


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
    assert strike(struck(made_up()(0.002)), AT).squirt != strike(struck(), AT).squirt
    terms = struck(dome, made_up()(-shift)).contact_terms
    assert terms.lever(phi) == pytest.approx((0.0, back), abs=1e-18)


def test_it_goes_with_the_others_in_any_order_and_however_it_is_split():
    others = (PowerLawTip(1.5), RollingContact(), TipDome(0.009))
    whole = strike(struck(made_up()(0.002), *others), AT)
    split = strike(struck(*others, made_up()(0.0005), made_up()(0.0015)), AT)
    assert imbalance(whole) < 1e-8
    assert split.squirt == pytest.approx(whole.squirt, rel=1e-9)


def test_it_is_seen_in_the_motion_and_in_the_bare_scene():
    scene = struck(made_up()(0.002))
    assert scene.bare == struck()
    moved, plain = (motion(s, [1e-3], AT).centre for s in (scene, scene.bare))
    assert np.abs(moved - plain).max() > 1e-9


def test_what_no_contact_honours_is_refused_by_its_terms():
    with pytest.raises(ValueError, match="takes a tip without give sideways, a fixed normal and a single"):
        strike(struck(made_up()(0.0, give=1.0), Elevation(0.1)), AT)
    with pytest.raises(ValueError, match=r"Scene\.effects must give the contact one window for a second hit; got"):
        struck(SecondHit(), made_up()(0.0, window=1e-3))
