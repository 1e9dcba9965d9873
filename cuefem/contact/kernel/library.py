"""The compiled kernel, loaded, and the fields of its input that describe the modes."""

from __future__ import annotations

import ctypes
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cuefem.contact.kernel import BINARY, BUILD, KernelError, check
from cuefem.contact.kernel.declarations import STEP, KernelContact, KernelTables
from cuefem.contact.modal_response import ModalPropagator, StepTables


def tables_pointer(tables: StepTables) -> Any:
    """The addresses of tables, which must outlive it, as an argument of the kernel."""
    addresses = {name: table.ctypes.data for name, table in zip(tables._fields[1:], tables[1:], strict=True)}
    return ctypes.byref(KernelTables(h=tables.h, **addresses))


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
