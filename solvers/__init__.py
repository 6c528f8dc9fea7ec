"""Solvers: numerics on arrays; no file format is known here."""

if __name__ != "zrno.solvers":
    raise ImportError(f"import this package as zrno.solvers, not as {__name__}: a bare import poisons numba's cache")
