"""Results: the registry of all quantities of a scene, solved designs, accuracy, uncertainty and comparison."""
