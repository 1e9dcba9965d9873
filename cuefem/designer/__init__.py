"""The designer: a page on this computer where a person turns a cue's knobs and sees at once what that does."""
