"""Which function reads which keyword."""

from __future__ import annotations

from collections.abc import Callable

from zrno.translators.lsdyna.deck import Deck
from zrno.translators.lsdyna.lexer import Block

# Takes the words of the name behind the registered ones; False: it does not know them, and nothing was read.
Handler = Callable[[Deck, Block, list[str]], bool]


class Registry:
    """Handlers by the first words of a keyword's name."""

    def __init__(self) -> None:
        self._handlers: dict[str, Handler] = {}

    def __call__(self, *names: str) -> Callable[[Handler], Handler]:
        """Decorator: register a handler."""

        def register(handler: Handler) -> Handler:
            for name in names:
                self._handlers[name] = handler
            return handler

        return register

    def update(self, other: Registry) -> None:
        """Take over another registry's."""
        self._handlers |= other._handlers

    def find(self, name: str) -> tuple[Handler, list[str]] | None:
        """The handler of the longest beginning of a name, and the words left over."""
        words = name.split("_")
        for count in range(min(len(words), 8), 0, -1):
            handler = self._handlers.get("_".join(words[:count]))
            if handler is not None:
                return handler, words[count:]
        return None


def take(options: list[str], *words: str) -> bool:
    """Take one of some words out of a name's options; whether it was there."""
    for word in words:
        if word in options:
            options.remove(word)
            return True
    return False
