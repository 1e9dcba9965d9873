"""The designer: a local browser page with sliders; squirt and other results update as they move."""
