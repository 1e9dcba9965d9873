"""What can be asked of a scene, each number declared once, and how designs are solved so that they can answer."""
