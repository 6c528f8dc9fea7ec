"""YAML as a tree whose keys and values know their line and column."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from zrno.translators.text import Faults


@dataclass(slots=True)
class Node:
    """A YAML value with its marks. value: a plain value, or {key: (node, place of the key)}."""

    value: Any
    place: tuple[int, int] = (1, 1)


def compose(data: bytes, faults: Faults) -> Node | None:
    """The file as a tree of nodes with marks; None of an empty document."""
    import yaml

    try:
        node = yaml.compose(data, Loader=yaml.SafeLoader)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        line, column = (mark.line + 1, mark.column + 1) if mark else (1, 1)
        faults.add(line, column, f"not YAML: {getattr(error, 'problem', None) or error}", expected="key: value")
        faults.stop()
    constructor = yaml.SafeLoader(b"")

    def convert(node: Any) -> Node:
        place = (node.start_mark.line + 1, node.start_mark.column + 1)
        if not isinstance(node, yaml.MappingNode):
            return Node(constructor.construct_object(node, deep=True), place)
        below: dict[str, tuple[Node, tuple[int, int]]] = {}
        for key, value in node.value:
            at = (key.start_mark.line + 1, key.start_mark.column + 1)
            if key.value in below:
                faults.add_at(at, "a key stands twice", key.value, "each key once")
            below[key.value] = (convert(value), at)
        return Node(below, place)

    return None if node is None else convert(node)
