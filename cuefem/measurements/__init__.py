"""Measurements on a cue, compared with computed values, and estimates of uncertain parameters from them.

predictions           computed values of measurements, each beam solved once
measurement_types     the types of measurements, one class each
recording             the natural frequencies of a tapped shaft, from a recording
shot, swerve          squirt as a maker reads it: a ball off the line at a distance
uncertain_parameters  the uncertain parameters of a drawing, and their priors
measured_cue          a cue with its measurements, and its residuals
measured_folder       a measured cue from a folder of files, and the template of such a folder
outliers              measurements of which some may be wrong
estimate              the uncertain parameters by least squares, their errors, and which measurement to make next
"""
