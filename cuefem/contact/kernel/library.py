"""The compiled kernel and the structures of its input and results."""

from __future__ import annotations

import ctypes
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cuefem.contact.kernel import BINARY, BUILD, KernelError, check
from cuefem.contact.modal_response import ModalPropagator, StepTables

_INTEGERS = "modes ports slopes forces speeds planes rolling law terms patch annuli dashpots radiating structural_loss"
_ARRAYS = (
    "radiating_modes omega rows mobility kinematics inverse_masses slope_weights force_terms compliance_terms "
    "annulus_edges annulus_forces annulus_slopes annulus_stiffness state ball"
)
_NUMBERS = (
    "restitution friction table_friction stiffness exponent indentation_limit compliance surface_restitution phi "
    "dome rim radius arm_t arm_n step max_time window next_step time indentation max_indentation angle height "
    "shear_loss damping_loss radiated axial_force max_slope"
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


class KernelTables(ctypes.Structure):
    """The structure StepTables of kernel/contact.h, the addresses of the fields of `StepTables`."""

    _fields_ = (
        (StepTables._fields[0], ctypes.c_double),
        *((name, ctypes.c_void_p) for name in StepTables._fields[1:]),
    )

    @classmethod
    def of(cls, tables: StepTables) -> KernelTables:
        """The addresses of tables, which must outlive it."""
        return cls(tables.h, *(table.ctypes.data for table in tables[1:]))


def mode_fields(propagator: ModalPropagator) -> tuple[dict[str, int], dict[str, NDArray[Any]]]:
    """The fields of Contact that describe the modes: numbers, and arrays except the state."""
    numbers = {
        "modes": len(propagator.tip.omega),
        "ports": len(propagator.ports),
        "slopes": len(propagator.slopes),
        "dashpots": len(propagator.dashpots),
        "radiating": len(propagator.radiating),
        "structural_loss": int(propagator.loss.any()),
    }
    return numbers, {
        "radiating_modes": propagator.radiating.astype(np.int32),
        "omega": propagator.tip.omega,
        "rows": propagator.rows,
    }


@cache
def library() -> ctypes.CDLL:
    """The compiled kernel. KernelError if it is missing, damaged or of other sources."""
    check()
    try:
        kernel = ctypes.CDLL(str(BINARY))
    except OSError as error:
        why = " ".join(str(error).split())
        raise KernelError(f"the contact's compiled kernel does not load ({why}); {BUILD}") from None
    sizes = [ctypes.c_size_t.in_dll(kernel, name).value for name in ("contact_size", "step_size", "tables_size")]
    if sizes != [ctypes.sizeof(KernelContact), STEP.itemsize, ctypes.sizeof(KernelTables)]:
        raise KernelError(f"the contact's compiled kernel has other structures; {BUILD}")
    kernel.contact_new.restype, kernel.contact_new.argtypes = ctypes.c_void_p, [ctypes.POINTER(KernelContact)]
    tables = ctypes.POINTER(KernelTables)
    kernel.contact_steps.argtypes = [ctypes.c_void_p, tables, ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p]
    kernel.imposed_velocity_impulse.restype = ctypes.c_double
    kernel.imposed_velocity_impulse.argtypes = [
        *(ctypes.c_void_p, tables, ctypes.c_int, ctypes.c_void_p, ctypes.c_double, ctypes.c_double)
    ]
    kernel.contact_free.restype, kernel.contact_free.argtypes = None, [ctypes.c_void_p]
    return kernel
