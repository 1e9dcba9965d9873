"""The effective end mass: its definitions, and a cue as two numbers."""
