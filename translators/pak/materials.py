"""Cards 11 and 12 of a PAK deck: which material models there are, and the materials of each."""

from __future__ import annotations

from typing import Any

from zrno.translators.model import Material, Model, Source
from zrno.translators.pak import cards as layouts
from zrno.translators.pak.laws import MODELS, read_law
from zrno.translators.text import Cards

Numbers = dict[tuple[int, int], int]  # (model, number within it) -> the material's number in the deck


def read_materials(cards: Cards, model: Model, count: int) -> Numbers:
    """Card 11 and the materials; `count` models."""
    heads = cards.block(layouts.MODEL, count, "card 11, a material model")
    heads.check("materials", heads["materials"] >= 0, "no such number of materials", "0 or more")
    known = [number in MODELS for number in heads["MODEL"].tolist()]
    for i in [i for i, good in enumerate(known) if not good][:20]:
        heads.fault(i, "MODEL", "this material model is not read", f"one of {', '.join(map(str, MODELS))}")
    cards.faults.stop()
    numbers: Numbers = {}
    for number, materials, points in zip(*(heads[name].tolist() for name in layouts.MODEL.fields), strict=True):
        for _ in range(materials):
            _read_one(cards, model, numbers, (number, materials, points))
    cards.faults.stop()
    return numbers


def _read_one(cards: Cards, model: Model, numbers: Numbers, head: tuple[int, int, int]) -> None:
    law, materials, points = head
    path, line = cards.faults.path, cards.next_line
    card = cards.card(layouts.MATERIAL, f"card 12, one of {materials} materials of model {law}")
    card.check("MOD", card["MOD"] == law, "the material is of another model", str(law))
    card.check("MAT", 1 <= card["MAT"] <= materials, "no such number within the model", f"1 to {materials}")
    if (law, card["MAT"]) in numbers:
        card.fault("MAT", "this material stands twice", "another number")
    cards.faults.stop()
    native: dict[str, Any] = {"MOD": law, "MAT": card["MAT"]}
    if rest := card.text("rest"):
        native["rest"] = card.block.whole()[layouts.MATERIAL.fields["rest"].start :].rstrip()[:45]
        if not rest.strip("0. "):
            del native["rest"]
    number = len(model.materials) + 1
    material = Material(number, law="", density=card["GUST"], source=Source(path, line), native=native)
    read_law(cards, material, law, points, lambda text: model.warnings.append(f"{path}:{line}: {text}"))
    model.materials[number] = material
    numbers[law, card["MAT"]] = number
