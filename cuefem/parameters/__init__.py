"""The one way to change a scene: parameters of files, studies, sliders and options, and the parts they reach."""
