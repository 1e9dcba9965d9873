"""Which law a contact's model asks for."""

from __future__ import annotations

from cuefem.contact.laws import RINGED_PATCH, ContactModel
from tests.oracle.contact import Contact
from tests.oracle.planar import Planar
from tests.oracle.raised import Raised
from tests.oracle.rings import Ringed


def oracle(model: ContactModel) -> Contact:
    """The contact of a model, when it is over."""
    if model.table is not None:
        return Raised(model).run()
    return (Ringed if model.patch == RINGED_PATCH else Planar)(model).run()
