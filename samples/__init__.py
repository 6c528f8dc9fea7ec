"""The shipped samples: each folder holds a scene, its mesh script, its reference and a README with the picture."""
