"""The papers' closed forms, one function an equation: [Kim], [Shepard], Alciatore's [A.31], [B.1].

Numpy only. Everything is per unit cue speed and broadcasts over arrays; masses are ratios to the ball's, except in
`closed_form`. m_e is always the effective end mass felt at the tip, m_c [Kim]'s mass of the cue end. Where what [Kim]
prints does not follow from its own equations these functions give the derived result; studies/paper/kim.md shows both.
"""

# ruff: noqa: F403

from cuefem.results.closed_forms import *
from studies.paper.closed_forms.coefficients import *
from studies.paper.closed_forms.cue_end import *
from studies.paper.closed_forms.kim_stroke import *
from studies.paper.closed_forms.light import *
from studies.paper.closed_forms.miscue import *
from studies.paper.closed_forms.published import *
