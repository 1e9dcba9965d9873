"""Cues that somebody measured: what was measured beside what is computed, and what the measurements tell.

numbers      what a shaft and its stroke do, each beam solved once
kinds        the measurements that a documented cue may hold, one class each
documented   a documented cue, and its table of measured and computed values
unknowns     what a drawing leaves open, and within what
estimate     the unknowns by least squares, their errors, and which measurement to make next
sampler      the same by a sampler (an extra), as a check of the errors
"""
