"""Output of the commands: records of SI numbers for programs, and tables of them for people.

`__init__.pyi` lists the names; each is loaded at its first use, so that a command loads its own tables only.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
