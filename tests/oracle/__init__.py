"""Other methods than the package's, which check it: a beam of its own and small steps of the contact; no tests."""
