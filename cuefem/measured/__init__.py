"""What somebody measured on a cue, beside what is computed, and what it tells.

numbers      what a shaft and its stroke do, each beam solved once
kinds        the measurements that a documented cue may hold, one class each
recording    the tones of a tapped shaft, from a recording
pendulum     the end mass by a ball on a thread
documented   a documented cue, and its table of measured and computed values
unknowns     what a drawing leaves open, and within what
estimate     the unknowns by least squares, their errors, and which measurement to make next
outliers     measurements of which some may be wrong
"""
