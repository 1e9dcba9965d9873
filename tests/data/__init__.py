"""Stored answers of the former engine, and the code that reads them for tests."""
