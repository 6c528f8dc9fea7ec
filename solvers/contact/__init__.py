"""Contact laws between bodies: one law a file."""
