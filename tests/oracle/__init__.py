"""Other methods than the package's, which check it: a beam of its own, small steps, the contact in NumPy; no tests."""
