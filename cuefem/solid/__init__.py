"""Shafts as solids of revolution, on scikit-fem (handbook: The solid)."""
