"""Pairs of decks, and the script that makes them."""
