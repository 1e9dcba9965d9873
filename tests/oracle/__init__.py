"""Independent methods: a beam by scikit-fem, small steps, partial slip, an exact chain, decimal impulses; no tests."""
