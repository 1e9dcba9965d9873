"""Cue meets ball: the coupled strike in time, and the impulse solver."""
