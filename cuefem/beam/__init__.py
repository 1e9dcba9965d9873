"""The shaft as a Timoshenko beam in p-version finite elements on scikit-fem: a cue and its effects become K and M.

Deflection w (degree p + 1) and rotation theta (degree p), so that w' can follow theta and nothing locks:

    stiffness  EI (theta')^2 + kGA (w' - theta)^2        mass  rhoA w'^2 (in time) + rhoI theta'^2 (in time)

Bending is linear along x from the tip (x = 0) to the butt; [Cowper], handbook: The beam.
"""

from cuefem.beam.basis import Table, line_basis, table
from cuefem.beam.mesh import ActsOnCue, Links, Mesh, Terms, mesh_cue
from cuefem.beam.system import System, assemble, element_matrices, gather, sections

__all__ = [
    "ActsOnCue",
    "Links",
    "Mesh",
    "System",
    "Table",
    "Terms",
    "assemble",
    "element_matrices",
    "gather",
    "line_basis",
    "mesh_cue",
    "sections",
    "table",
]
