"""Elements at their integration points: shape functions, strains, loops over many elements; laws at many points."""
