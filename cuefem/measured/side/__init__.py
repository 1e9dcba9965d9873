"""A strike across the axis of a cue, or of any beam: how a ball or a hammer bounces off its side."""
