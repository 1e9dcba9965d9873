"""The contact's one method in plain NumPy: a readable specification, and what the compiled kernel is compared with."""
