"""The cap model at a point: a script, see `cap_point`."""
