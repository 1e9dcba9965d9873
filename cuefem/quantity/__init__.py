"""What a number may be: fields with units and bounds, the table of units, and numbers that cannot be meant."""
