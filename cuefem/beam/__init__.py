"""The shaft as a Timoshenko beam in p-version finite elements: a cue and its effects become K and M.

The deflection w has polynomial degree p + 1 and the rotation theta degree p, which avoids shear locking:

    stiffness  EI (theta')^2 + kGA (w' - theta)^2        mass  rhoA w'^2 (in time) + rhoI theta'^2 (in time)

Bending is linear along x from the tip (x = 0) to the butt; see [Cowper] and handbook: The beam.

`cuefem.beam.weak_forms` defines both in scikit-fem. `cuefem.beam.assembly` assembles the same K and M five times as
fast from scikit-fem's hierarchical basis, tabulated in `cuefem.beam.basis`. `cuefem.beam.meshing` chooses the elements
from the phases of the bending waves (`cuefem.beam.mode_count`). `cuefem.beam.modes` solves for the bending modes by
`cuefem.beam.eigensolver`, which solves for axial modes too. `cuefem.beam.truncation` corrects for truncated modes,
and `cuefem.beam.tip_modes` reduces all modes to their motion at the tip, which determines an impact.
"""
