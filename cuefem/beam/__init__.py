"""The shaft as a Timoshenko beam in p-version finite elements: a cue and its effects become K and M.

The deflection w has polynomial degree p + 1 and the rotation theta degree p, so that w' can follow theta and nothing
locks:

    stiffness  EI (theta')^2 + kGA (w' - theta)^2        mass  rhoA w'^2 (in time) + rhoI theta'^2 (in time)

Bending is linear along x from the tip (x = 0) to the butt; see [Cowper] and handbook: The beam.

`weak_forms` states both in scikit-fem, which is the definition. `system` assembles the same K and M five times as fast:
the basis functions are scikit-fem's hierarchical ones, tabulated (`basis`), on the mesh that `waves` and `mesh` choose.
`modes` solves for the bending modes by `spectrum`, which solves for those along the axis too, `tail` stands for the
modes left out, and `tip` holds what an impact sees of them.
"""
