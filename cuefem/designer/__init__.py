"""The designer: a page on this computer where a person changes a cue and sees at once what that does to squirt."""
