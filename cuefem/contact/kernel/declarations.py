"""The constants and structures of contact.h, read from it: there is no second declaration."""

from __future__ import annotations

import ctypes
import re
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cuefem.contact.kernel import HERE

HEADER = re.sub(r"/\*.*?\*/", "", (HERE / "contact.h").read_text(encoding="utf-8"), flags=re.DOTALL)
C_TYPES: dict[str, Any] = {"bool": ctypes.c_bool, "int": ctypes.c_int, "double": ctypes.c_double}
DECLARATOR = re.compile(r"\s*(?P<pointer>\*?)(?P<name>\w+)(?:\[(?P<size>\w+)\])?\s*")


def enum_constants() -> dict[str, int]:
    """Names and values of all enums; a value is a number or a sum of constants, or one more than the last."""
    values: dict[str, int] = {}
    for body in re.findall(r"enum \{([^}]*)\}", HEADER):
        value = -1
        for entry in filter(str.strip, body.split(",")):
            name, _, expression = entry.partition("=")
            terms = expression.replace(" ", "").split("+") if expression else [str(value + 1)]
            value = sum(values[term] if term in values else int(term) for term in terms)
            values[name.strip()] = value
    return values


CONSTANTS = enum_constants()


class Declaration(NamedTuple):
    """A field of a structure, a pointer, an array of ``size``, or a number (size None)."""

    name: str
    c_type: str
    is_pointer: bool
    size: int | None

    @property
    def in_ctypes(self) -> tuple[str, Any]:
        """Its name and type; of a pointer, an address."""
        one = ctypes.c_void_p if self.is_pointer else C_TYPES[self.c_type]
        return self.name, one if self.size is None else one * self.size


def declarations_of(structure: str) -> Iterator[Declaration]:
    """The fields of a structure."""
    bodies = {name: body for body, name in re.findall(r"typedef struct \{([^}]*)\} (\w+);", HEADER)}
    for line in bodies[structure].split(";")[:-1]:
        c_type, declarators = line.replace("const ", "").split(maxsplit=1)
        for declarator in declarators.split(","):
            match = DECLARATOR.fullmatch(declarator)
            assert match is not None, f"contact.h, {structure}: {declarator}"
            size = CONSTANTS[match["size"]] if match["size"] else None
            yield Declaration(match["name"], c_type, bool(match["pointer"]), size)


class ArrayField:
    """A pointer of a structure. An array is assigned to it and read from it, and lives as long as the structure."""

    def __init__(self, declaration: Declaration, address: Any) -> None:
        self.name, self.address = declaration.name, address
        self.dtype = np.dtype(C_TYPES[declaration.c_type])

    def __get__(self, structure: Any, owner: type) -> NDArray[Any]:
        array: NDArray[Any] = structure.arrays[self.name]
        return array

    def __set__(self, structure: Any, values: NDArray[Any]) -> None:
        array = np.ascontiguousarray(values, self.dtype)
        structure.arrays[self.name] = array
        self.address.__set__(structure, array.ctypes.data)


class Declared(ctypes.Structure):
    """A structure of contact.h. AttributeError for a field that it has not."""

    __slots__ = ("arrays",)

    def __init__(self, **values: Any) -> None:
        self.arrays: dict[str, NDArray[Any]] = {}
        super().__init__(**values)

    if TYPE_CHECKING:  # the header has the fields

        def __getattr__(self, name: str) -> Any: ...
        def __setattr__(self, name: str, value: Any) -> None: ...


def declared(name: str) -> Callable[[type[Declared]], type[Declared]]:
    """Give a class the fields of a structure of contact.h."""

    def with_fields(structure: type[Declared]) -> type[Declared]:
        declarations = list(declarations_of(name))
        structure._fields_ = [declaration.in_ctypes for declaration in declarations]
        for declaration in declarations:
            if declaration.is_pointer:
                field = ArrayField(declaration, getattr(structure, declaration.name))
                setattr(structure, declaration.name, field)
        return structure

    return with_fields


@declared("Input")
class KernelInput(Declared):
    """What is constant during a contact."""

    __slots__ = ()


@declared("State")
class KernelState(Declared):
    """What one step of a contact leaves to the next."""

    __slots__ = ()


@declared("Step")
class KernelStep(Declared):
    """Record of a step."""

    __slots__ = ()


@declared("StepTables")
class StepTables(Declared):
    """What the modes do in a step of the length h, s.

    c is the number of ports and slopes, d that of dashpots, n that of modes, m that of radiating modes. A state is (2
    n,): the velocities, then a.

    own: (3, n), v_v, sine and a_a of `Oscillators`; 0 of the modes that radiate. ends, means: (c, 2 n), from the state
    to the velocities of ports and slopes at the end of the step and on average over it, dashpots included.
    end_per_load, mean_per_load: (c, c), the same from loads on ports and slopes. response: (c + d, 2 n), change of the
    state of the modes that do not radiate, per load. dashpots: (d, 2 n + c), the dashpots' forces from the state and
    the loads. radiating: (2 m, 3 m), state of the modes that radiate, from the x of `CoupledModes`.
    """

    __slots__ = ()


STEP = np.dtype(KernelStep)
