"""The effective end mass: its definitions, and the lumped cue of a finite-element cue."""
