"""Translators: mesh files and decks to the model, and the model to decks; no numerics, no solver."""

if __name__ != "zrno.translators":
    raise ImportError(f"import this package as zrno.translators, not as {__name__}: a bare import poisons numba's cache")
