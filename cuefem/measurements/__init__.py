"""What somebody measured on a cue, beside what is computed, and what it tells.

predictions           what a shaft and its stroke do, each beam solved once
measurement_types     the measurements that a measured cue may hold, one class each
recording             the tones of a tapped shaft, from a recording
pendulum              the end mass by a ball on a thread
uncertain_parameters  what a drawing leaves open, and within what
measured_cue          a cue with its measurements, and the table of measured and computed values
outliers              measurements of which some may be wrong
estimate              the uncertain parameters by least squares, their errors, and which measurement to make next
"""
