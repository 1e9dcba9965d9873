"""From a cue shaft's drawing to its effective end mass and squirt.

`__init__.pyi` lists the public names. Each is imported at its first use, which keeps `import cuefem` fast.
"""

import lazy_loader as _lazy_loader

__version__ = "0.3.0.dev0"

__getattr__, __dir__, __all__ = _lazy_loader.attach_stub(__name__, __file__)
