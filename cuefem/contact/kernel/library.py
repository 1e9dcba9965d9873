"""The compiled kernel and the structures of its input and results."""

from __future__ import annotations

import ctypes
from functools import cache

import numpy as np

from cuefem.contact.kernel import BINARY, BUILD, KernelError, check

_INTEGERS = "modes ports slopes forces speeds planes rolling law terms patch annuli"
_ARRAYS = (
    "eigenvalues outputs inputs kinematics inverse_masses slope_weights force_terms compliance_terms "
    "annulus_edges annulus_forces annulus_slopes annulus_stiffness xi ball"
)
_NUMBERS = (
    "restitution friction table_friction stiffness exponent indentation_limit compliance surface_restitution phi "
    "dome rim radius arm_t arm_n step max_time window time indentation max_indentation angle height shear_loss "
    "axial_force max_slope"
)
# The structure Step of kernel/contact.h; F and v have one entry a force, ball one a velocity of the ball.
_ONE, _SIX = ("time", "length", "friction_state", "phase", "angle"), ("F", "v", "ball")
STEP = np.dtype([*((name, float) for name in _ONE), *((name, float, 6) for name in _SIX)])


class KernelContact(ctypes.Structure):
    """The structure Contact of kernel/contact.h, field by field."""

    _fields_ = (
        *((name, ctypes.c_int) for name in _INTEGERS.split()),
        *((name, ctypes.c_void_p) for name in _ARRAYS.split()),
        *((name, ctypes.c_double) for name in _NUMBERS.split()),
        ("work", ctypes.c_double * 6),
        *((name, ctypes.c_int) for name in ("status", "friction_state", "steps", "steps_to_last_separation")),
    )


@cache
def library() -> ctypes.CDLL:
    """The compiled kernel. KernelError if it is missing, damaged or of other sources."""
    check()
    try:
        kernel = ctypes.CDLL(str(BINARY))
    except OSError as error:
        why = " ".join(str(error).split())
        raise KernelError(f"the contact's compiled kernel does not load ({why}); {BUILD}") from None
    sizes = [ctypes.c_size_t.in_dll(kernel, name).value for name in ("contact_size", "step_size")]
    if sizes != [ctypes.sizeof(KernelContact), STEP.itemsize]:
        raise KernelError(f"the contact's compiled kernel has other structures; {BUILD}")
    kernel.contact_new.restype, kernel.contact_new.argtypes = ctypes.c_void_p, [ctypes.POINTER(KernelContact)]
    kernel.contact_steps.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p]
    kernel.contact_free.restype, kernel.contact_free.argtypes = None, [ctypes.c_void_p]
    return kernel
