"""The class of an effect at the tip, which its class alone registers; no tests."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from cuefem.effects.contact_terms import ContactTerms
from cuefem.effects.effect import TipEffect
from cuefem.quantity.fields import Quantity


def cap_effect() -> type[TipEffect]:
    """The class of an effect at the tip."""

    @dataclass(frozen=True)
    class Cap(TipEffect):
        """A round cap on the tip, of ``radius``, m."""

        radius: Annotated[float, Quantity("m")]
        compliance: float = 0.0

        def add_to_contact(self, terms: ContactTerms) -> None:
            """A dome, and a tangential compliance relative to the normal one."""
            terms.add_dome(self.radius)
            if self.compliance:
                terms.add_compliance(self.compliance)

    return Cap
