"""The shaft as a Timoshenko beam in p-version finite elements on scikit-fem: a cue and its effects become K and M.

The deflection w has polynomial degree p + 1 and the rotation theta degree p, so that w' can follow theta and nothing
locks:

    stiffness  EI (theta')^2 + kGA (w' - theta)^2        mass  rhoA w'^2 (in time) + rhoI theta'^2 (in time)

Bending is linear along x from the tip (x = 0) to the butt; see [Cowper] and physics.md section 4.

`system` assembles K and M, `modes` solves for the bending modes, `tail` stands for the modes left out, and `tip` holds
what an impact sees of them. Only `tip` and `waves` do without scikit-fem, so this package hands on no names.
"""
