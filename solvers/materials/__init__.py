"""Material laws: one law a file, a stress update at one point, used by particles and finite elements alike."""
