"""Independent methods: a spectral beam, small steps, partial slip, an exact chain, decimal impulses; no tests."""
