"""Text of the article that holds no computed number."""

MODEL = """\
**The shaft** is a tapered Timoshenko beam of wood, with its ferrule, bore and joint as drawn; along the axis it goes
on as a tapered butt. Finite elements give its free modes; the static compliance of the truncated modes is added.
**The tip** is a short cylinder of leather with a dome. 3-D elasticity, tabulated once, gives the force F(d) of a ball
at indentation d in a central impact, and the stiffness k(a) across the tip of a patch of radius a. Restitution e
unloads along the same curve with d scaled by e², a law without a source of its own. **The patch** is strained ring by
ring since it touched, each ring up to mu times its part of the normal force (Cattaneo 1938; Mindlin and Deresiewicz
1953; Jäger 1998). **The axial force** F_x bends the deflected shaft further (P-delta):

```text
F_t = sum of f_r          f_r -> clip(f_r + dk_r dv, +- mu dN_r)
V = -1/2 F_x (q'G q + l theta^2),        G_ij = integral of p w_i' w_j' dx
```

p is the share of the cue's mass behind x, theta the rotation at the ferrule's end, l the distance to the dome."""
VERIFICATION = """\
The beam: 3-D elasticity on scikit-fem, six modes of Kim's cone within 4.3e-6 ([solid](../beam/solid.md)). The patch: a
boundary-element solver with vector friction gives the squirt of a half-space to 0.0 %, of a bonded layer of 6 mm to
0.04, 0.3 and 1.1 % at b/R 0.187, 0.375 and 0.453. The contact: small steps that share nothing with it (tests/oracle).
The axial force: columns buckle at Engesser's load; a geometrically exact chain of links agrees to a thousandth of the
change."""
UNKNOWN = """\
How leather gives back work: other laws of loss exist (Hunt and Crossley 1975; Ting 1966 for a viscoelastic half-space),
and a ball dropped at a slant on a clamped tip would tell. The wood, tapers and bores of the measured shafts are
assumed. Squirt of one known shaft at five offsets, left and right, to 3 %, would decide most of what is open. Change of
squirt, % ([left_out](../contact/left_out.md)):"""
SOURCES = """\
Measured: D. G. Alciatore, Billiards Digest, September and November 2007, February 2008; billiards.colostate.edu, TP
A.30, A.31, B.1. End mass: R. Shepard, *Everything you always wanted to know about cue ball squirt* (2001). Squirt:
R. Cross, Am. J. Phys. 76 (2008). Lumped cue: H.-C. Kim, *Motions of a billiard ball after a cue stroke*. Patch: C.
Cattaneo, Rend. Accad. Naz. Lincei (1938); R. D. Mindlin and H. Deresiewicz, J. Appl. Mech. (1953); J. Jäger, J.
Tribol. (1998); K. L. Johnson, *Contact Mechanics* (1985), ch. 7. Loss: K. H. Hunt and F. R. E. Crossley, J. Appl.
Mech. (1975); T. C. T. Ting, J. Appl. Mech. (1966). Axial force: F. Engesser (1889); S. P. Timoshenko and J. M. Gere,
*Theory of Elastic Stability* (1961), ch. 2."""
