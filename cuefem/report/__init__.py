"""What the commands show: records of plain SI numbers for programs, and readable tables made of them for people.

The names stand in `__init__.pyi`; each is loaded when it is first used, so that a command loads its own tables alone.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
