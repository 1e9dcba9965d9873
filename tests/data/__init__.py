"""What the former engine answered: the data, how they were made, and how a test reads them."""
