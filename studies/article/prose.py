"""Text of the article without computed numbers."""

MODEL = """\
**The shaft** is a tapered Timoshenko beam of wood, with ferrule, bore and joint as in the drawing; for axial waves it
continues as a tapered butt. Finite elements give its free-free modes; the static compliance of the truncated modes is
added. **The tip** is a short cylinder of leather with a dome. Tabulated 3-D elasticity gives the force F(d) of a ball
at indentation d in a central impact, and the tangential stiffness k(a) of a contact of radius a. The restitution phase
follows the same curve with d scaled by e², a law without a published source. **Partial slip**: each annulus is strained
since it came into contact, up to mu times its part of the normal force (Cattaneo 1938; Mindlin and Deresiewicz
1953; Jäger 1998). **The axial force** F_x increases the deflection of the bent shaft (P-delta):

```text
F_t = sum of f_r          f_r -> clip(f_r + dk_r dv, +- mu dN_r)
V = -1/2 F_x (q'G q + l theta^2),        G_ij = integral of p w_i' w_j' dx
```

p is the share of the cue's mass behind x, theta the rotation at the ferrule's end, l the distance to the dome."""
VERIFICATION = """\
Beam: 3-D elasticity on scikit-fem, six modes of Kim's cone within 4.3e-6 ([solid](../beam/solid.md)). Partial slip: a
boundary-element solver with vector friction gives the squirt on a half-space to 0.0 %, on a bonded layer of 6 mm to
0.04, 0.3 and 1.1 % at b/R 0.187, 0.375 and 0.453. Contact: an independent code with small steps (tests/oracle).
Axial force: columns buckle at Engesser's load; a geometrically exact chain of links gives the change to 0.1 %."""
UNKNOWN = """\
The dissipation law of leather: others exist (Hunt and Crossley 1975; Ting 1966 for a viscoelastic half-space); a ball
dropped obliquely on a clamped tip would discriminate between them. The wood, tapers and bores of the measured shafts
are assumed. Squirt of one known shaft at five offsets, left and right, to 3 %, would resolve most of these questions.
Four results name measurements that would decide them: two balls on one shaft
([two_balls](../measured/two_balls.md)), clay along a shaft ([distribution](../end_mass/distribution.md)), miscues of
two shafts ([miscue_limit](../contact/miscue_limit.md)), and the stiffness of sold shafts
([fronts](../design/fronts.md)).
Change of squirt, % ([left_out](../contact/left_out.md)):"""
SOURCES = """\
Measured: D. G. Alciatore, Billiards Digest, September and November 2007, February 2008; billiards.colostate.edu, TP
A.30, A.31, B.1. End mass: R. Shepard, *Everything you always wanted to know about cue ball squirt* (2001). Squirt:
R. Cross, Am. J. Phys. 76 (2008). Lumped cue: H.-C. Kim, *Motions of a billiard ball after a cue stroke*. Patch: C.
Cattaneo, Rend. Accad. Naz. Lincei (1938); R. D. Mindlin and H. Deresiewicz, J. Appl. Mech. (1953); J. Jäger, J.
Tribol. (1998); K. L. Johnson, *Contact Mechanics* (1985), ch. 7. Loss: K. H. Hunt and F. R. E. Crossley, J. Appl.
Mech. (1975); T. C. T. Ting, J. Appl. Mech. (1966). Axial force: F. Engesser (1889); S. P. Timoshenko and J. M. Gere,
*Theory of Elastic Stability* (1961), ch. 2."""
