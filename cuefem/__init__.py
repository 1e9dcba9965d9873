"""From a cue shaft's drawing to its effective end mass and squirt.

`__init__.pyi` lists the public names. Each is imported at its first use, which keeps `import cuefem` fast.
"""

from typing import Any as _Any

import lazy_loader as _lazy_loader

__version__ = "0.3.0.dev0"

_listed, __dir__, __all__ = _lazy_loader.attach_stub(__name__, __file__)


def __getattr__(name: str) -> _Any:
    """A public name of the list, or the call of a registered question, which needs no line there."""
    if name not in __all__:
        from cuefem.analysis import public_question  # not for the listed names

        question = public_question(name)
        if question is not None:
            return question
    return _listed(name)
