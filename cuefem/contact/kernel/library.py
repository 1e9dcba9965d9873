"""The compiled kernel, loaded."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache

from cuefem.contact.kernel import BINARY, BUILD, KernelError, check
from cuefem.contact.kernel.declarations import KernelInput, KernelState, StepTables


@cache
def library() -> ctypes.CDLL:
    """The compiled kernel. KernelError if it is missing, damaged or of other sources."""
    check()
    try:
        kernel = ctypes.CDLL(str(BINARY))
    except OSError as error:
        why = " ".join(str(error).split())
        raise KernelError(f"the contact's compiled kernel does not load ({why}); {BUILD}") from None
    pointers = [ctypes.POINTER(structure) for structure in (KernelInput, KernelState, StepTables)]
    of_input, of_state, of_tables = pointers
    kernel.contact_new.restype, kernel.contact_new.argtypes = ctypes.c_void_p, [of_input, of_state]
    kernel.contact_steps.argtypes = [ctypes.c_void_p, of_tables, ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p]
    kernel.imposed_velocity_impulse.restype = ctypes.c_double
    kernel.imposed_velocity_impulse.argtypes = [
        *(ctypes.c_void_p, of_tables, ctypes.c_int, ctypes.c_void_p, ctypes.c_double, ctypes.c_double)
    ]
    kernel.contact_free.restype, kernel.contact_free.argtypes = None, [ctypes.c_void_p]
    return kernel


@contextmanager
def new_contact(fields: KernelInput, state: KernelState) -> Iterator[int]:
    """A contact of the kernel at its first touch; MemoryError without memory for it."""
    contact = library().contact_new(fields, state)
    if not contact:
        raise MemoryError("no memory for the steps of a contact")
    try:
        yield contact
    finally:
        library().contact_free(contact)
