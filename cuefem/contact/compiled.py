"""What goes to the compiled kernel and comes back."""

from __future__ import annotations

import ctypes
from functools import cache

from cuefem.contact.kernel import BINARY, BUILD, KernelError, check
from cuefem.contact.rule import tables

_INTEGERS = "forces speeds turns curve patch lossy terms levers rings recording plane"
_POINTERS = (
    "cue facing ball_gives force_terms give_terms lever_terms ring_edges ring_forces ring_slopes ring_stiffness "
    "xi ball ring_shear slope_weights slopes"
)
_NUMBERS = (
    "restitution friction table_friction stiffness exponent most compliance first_ratio surface_restitution phi "
    "dome rim radius lever_t lever_n lever_reach speed across clock impulse tolerance longest window most_phases "
    "most_steps"
)
_RESULTS = "time depth angle shear deepest peak height friction_loss shear_loss table_loss damping_loss radiated"
_BENDING = "thrust steepest"
_COUNTS = "status parted grip press steps tried rounds phase_count record_count row"


class KernelContact(ctypes.Structure):
    """The structure Contact of kernel/contact.h, field by field."""

    _fields_ = (
        *((name, ctypes.c_void_p) for name in _POINTERS.split()),
        *((name, ctypes.c_int) for name in _INTEGERS.split()),
        *((name, ctypes.c_double) for name in f"{_NUMBERS} {_RESULTS} {_BENDING}".split()),
        *((name, ctypes.c_int) for name in _COUNTS.split()),
        ("phases", ctypes.POINTER(ctypes.c_double)),
        ("records", ctypes.POINTER(ctypes.c_double)),
    )


@cache
def library() -> ctypes.CDLL:
    """The kernel, its rule set; KernelError where there is none to use."""
    check()
    try:
        kernel = ctypes.CDLL(str(BINARY))
    except OSError as error:
        why = " ".join(str(error).split())
        raise KernelError(f"the contact's compiled kernel does not load ({why}); {BUILD}") from None
    rule = tables()
    sizes = [ctypes.c_size_t.in_dll(kernel, name).value for name in ("rule_size", "contact_size")]
    if sizes != [rule.nbytes, ctypes.sizeof(KernelContact)]:
        raise KernelError(f"the contact's compiled kernel has other structures; {BUILD}")
    ctypes.memmove(ctypes.addressof(ctypes.c_char.in_dll(kernel, "rule")), rule.ctypes.data, rule.nbytes)
    pointer, count = ctypes.c_void_p, ctypes.c_int
    kernel.cue_new.restype, kernel.cue_new.argtypes = pointer, [count] * 4 + [pointer] * 3
    kernel.cue_free.restype, kernel.cue_free.argtypes = None, [pointer]
    kernel.cue_follow.restype = None
    kernel.cue_follow.argtypes = [pointer, pointer, pointer, pointer, count, pointer]
    for name in ("contact_run", "contact_free"):
        function = getattr(kernel, name)
        function.restype, function.argtypes = None, [ctypes.POINTER(KernelContact)]
    return kernel
