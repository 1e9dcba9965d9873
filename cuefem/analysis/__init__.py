"""Analyses of a scene: one file for each question, with its computation, its result, its tables and its charts."""
