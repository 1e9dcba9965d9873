"""Shared by tests: cues, scenes, files, browser, commands; no tests."""
