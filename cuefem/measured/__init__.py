"""What somebody measured: a cue's tones, weight, stiffness, squirt; beside what is computed, and what it tells.

A tap, from the recording to the wood:

ringing      each tap's free decay cut out of a recording; hum: mains hum taken out of it
tones        the damped tones of such decays
matching     which bending mode each tone is; chance: how likely that tones fit that are not the shaft's
wood         the wood that has these tones; fit: the result; doubts: reasons not to believe it

All that was measured on a cue:

numbers      what a shaft and its stroke do, each beam solved once
kinds        the measurements that a documented cue may hold, one class each
documented   a documented cue, and its table of measured and computed values
unknowns     what a drawing leaves open, and within what
estimate     the unknowns by least squares, their errors, and which measurement to make next
outliers     numbers of which some may be wrong
pendulum     the end mass by a ball on a thread
"""
