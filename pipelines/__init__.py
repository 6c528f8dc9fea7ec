"""Pipelines: what a person does, from mesh to picture; no physics."""

if __name__ != "zrno.pipelines":
    raise ImportError(f"import this package as zrno.pipelines, not as {__name__}: a bare import poisons numba's cache")
