"""The tap test: tones in a recording, and the wood that has them."""
