"""From a cue shaft's drawing to its effective end mass and squirt.

The public names stand in `__init__.pyi`; each is loaded when it is first used, so that `import cuefem` costs next to
nothing.
"""

import lazy_loader as _lazy_loader

__version__ = "0.2.0"

__getattr__, __dir__, __all__ = _lazy_loader.attach_stub(__name__, __file__)
