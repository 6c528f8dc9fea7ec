"""Writer of LS-DYNA keyword decks: standard columns; ids of ten where they need them; long where a number does."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from zrno.translators.lsdyna.cards_out import Card, Writer
from zrno.translators.lsdyna.control import ANALYSIS
from zrno.translators.lsdyna.from_particles import mesh_of
from zrno.translators.lsdyna.lexer import Widths
from zrno.translators.lsdyna.write_conditions import Conditions
from zrno.translators.lsdyna.write_laws import equation, material
from zrno.translators.lsdyna.write_mesh import Mesh
from zrno.translators.lsdyna.write_parts import parts, sections
from zrno.translators.model import Model
from zrno.translators.report import Report
from zrno.translators.text import write_atomically

_LARGEST_STANDARD, _LARGEST = 99_999_999, 9_999_999_999


def write(model: Model, path: Path | str) -> Report:
    """Write a model as a keyword deck; the file appears whole or not at all.

    Returns what the deck cannot say. Raises ValueError for a model that is incomplete, or has nothing to write.
    """
    if model.incomplete:
        raise ValueError("the model lacks what it names: " + "; ".join(model.incomplete[:5]))
    report = Report()
    model = mesh_of(model, report)
    mesh = Mesh(model, report)
    largest = mesh.largest_id()
    if (most := max(largest, mesh.largest_of_sets())) > _LARGEST:
        raise ValueError(f"the number {most} has more than ten digits: no keyword deck can hold it")
    writer = Writer(Widths.I10 if largest > _LARGEST_STANDARD else Widths.STANDARD, report)
    write_atomically(path, _pieces(model, mesh, writer, report))
    report.approximate("numbers", writer.inexact, "rounded to the 20 columns of the long format")
    return report


def _pieces(model: Model, mesh: Mesh, writer: Writer, report: Report) -> Iterator[bytes]:
    yield b"*KEYWORD I10=Y\n" if writer.widths is Widths.I10 else b"*KEYWORD\n"
    if model.title:
        yield writer.keyword("TITLE", [model.title[:80]])
    yield from _control(model, writer)
    conditions = Conditions(model, writer, report)
    yield from parts(model, writer)
    yield from sections(model, writer, report)
    for one in model.materials.values():
        yield material(one, writer, report)
    for eos in model.equations_of_state.values():
        yield equation(eos, writer, report)
    yield from conditions.pieces()
    for name, widths, text in model.native.get("lsdyna", ()):
        yield writer.raw(name, widths, text.split("\n") if text else [])
    yield from mesh.pieces(writer)
    yield b"*END\n"
    for what, count in (
        ("equations between degrees of freedom", len(model.equations)),
        ("FEM control cards", int(model.fem_control is not None)),
    ):
        report.drop(what, count, "not written to a keyword deck")


def _control(model: Model, writer: Writer) -> Iterator[bytes]:
    """The analysis' values, in the cards that they were read from where those are kept."""
    kept = model.native.get("lsdyna_control", {})
    analysis = model.analysis
    for keyword, attributes in ANALYSIS.items():
        values = {place: getattr(analysis, name) for name, (place, _) in attributes.items()}
        if keyword in kept:
            widths, lines = kept[keyword]
            yield writer.raw(keyword, widths, [_patched(lines[0] if lines else "", widths, values), *lines[1:]])
        elif any(value is not None for value in values.values()):
            fields = {"v": [values.get(i) for i in range(2)]}
            yield writer.keyword(keyword, [("v*2", fields)])
    raw = {name.split()[0] for name, _, _ in model.native.get("lsdyna", ())}
    if not any(name.startswith("CONTROL_IMPLICIT") for name in raw):
        implicit: dict[str, list[Card]] = {
            "static": [("imflag/i dt0", {"imflag": 1, "dt0": analysis.initial_step})],
            "dynamic": [("imflag/i dt0", {"imflag": 1, "dt0": analysis.initial_step})],
        }
        if analysis.kind in implicit:
            yield writer.keyword("CONTROL_IMPLICIT_GENERAL", implicit[analysis.kind])
        if analysis.kind == "dynamic":
            yield writer.keyword("CONTROL_IMPLICIT_DYNAMICS", [("imass/i", {"imass": 1})])
        if analysis.kind == "eigenvalues":
            yield writer.keyword("CONTROL_IMPLICIT_EIGENVALUE", [("neig/i", {"neig": 10})])


def _patched(line: str, widths: str, values: dict[int, float | None]) -> str:
    """A card's line with some of its first fields replaced where the model has other values now."""
    from zrno.translators.real_text import real_text
    from zrno.translators.text import parse_real

    width = Widths(widths).of(10)
    free = "," in line
    fields = line.split(",") if free else [line[i : i + width] for i in range(0, max(len(line), width), width)]
    for place, value in values.items():
        while len(fields) <= place:
            fields.append("" if free else " " * width)
        if (parse_real(fields[place]) or None) != value:
            text = "" if value is None else real_text(value, width)[0]
            fields[place] = text if free else text.rjust(width)
    return (",".join(fields) if free else "".join(field.ljust(width) for field in fields)).rstrip()
