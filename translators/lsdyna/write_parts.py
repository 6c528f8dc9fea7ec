"""Parts and sections as cards."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from zrno.translators.lsdyna.cards_out import Card, Writer
from zrno.translators.lsdyna.tables import PARTS_CARD, SECTION_OF_KIND, SECTIONS, SectionRow
from zrno.translators.model import Model, Part, Section
from zrno.translators.report import Report


def parts(model: Model, writer: Writer) -> Iterator[bytes]:
    """*PART of each part; those that only elements named stay so."""
    for part in model.parts.values():
        if part.native.get("implied"):
            continue
        eos = part.eos
        if eos is None and part.material in model.materials:
            eos = model.materials[part.material].eos
        fields: dict[str, Any] = {
            "pid": part.id,
            "secid": part.section or 0,
            "mid": part.material or 0,
            "eosid": eos or 0,
        }
        fields |= {name: part.native[name] for name in ("hgid", "grav", "adpopt", "tmid") if name in part.native}
        yield _part(part, fields, writer)


def _part(part: Part, fields: dict[str, Any], writer: Writer) -> bytes:
    title = part.name[:80]
    if "cards" not in part.native:
        return writer.keyword("PART", [title, (PARTS_CARD, fields)])
    piece = writer.keyword(f"PART_{part.native['options']}", [title, (PARTS_CARD, fields)])
    lines = "\n".join(part.native["cards"])
    return piece + f"{lines}\n".encode("latin-1", "replace")


def sections(model: Model, writer: Writer, report: Report) -> Iterator[bytes]:
    """*SECTION_... of each section."""
    for section in model.sections.values():
        row = SECTIONS.get(str(section.native.get("keyword", "")).removeprefix("SECTION_"))
        own = row is not None and _says(row, section)
        if row is None or not own:
            row = SECTION_OF_KIND.get({"plane": "shell", "truss": "beam"}.get(section.kind, section.kind))
        if row is None:
            report.drop("sections", 1, f"a keyword deck has no section of {section.kind or 'an unknown kind'}")
            continue
        fields = dict(section.native) if own else _fields(section, row, report)
        fields["secid"] = section.id
        name = row.keyword + ("_TITLE" if section.name else "")
        cards: list[Card] = [section.name[:80]] if section.name else []
        cards += [(spec, fields) for spec in row.cards_of(int(fields.get("elform", 0)))]
        yield writer.keyword(name, cards)


def _says(row: SectionRow, section: Section) -> bool:
    """Whether the fields that a section was read from still say what it is."""
    return row.parameters(section.native) == section.parameters and row.plane(section.native) == section.plane


def _fields(section: Section, row: SectionRow, report: Report) -> dict[str, Any]:
    parameters = dict(section.parameters)
    fields: dict[str, Any] = {key: parameters.pop(name) for name, key in row.names.items() if name in parameters}
    if row.kind == "shell":
        plane = {"stress": 12, "strain": 13, "axisymmetric": 15}.get(section.plane)
        if plane:
            fields["elform"] = plane
        thickness = parameters.pop("thickness", None)
        for i in range(1, 5):
            value = parameters.pop(f"thickness_{i}", thickness)
            if value is not None:
                fields[f"t{i}"] = value
    elif row.kind == "beam":
        truss = section.kind == "truss"
        fields["elform"] = 3 if truss else 2
        names = {"area": "a"} if truss else {"area": "a", "iyy": "iss", "izz": "itt", "j": "j", "shear_area_y": "sa"}
        fields |= {key: parameters.pop(name) for name, key in names.items() if name in parameters}
    if parameters:
        report.drop("section parameters", len(parameters), f"section {section.id}: " + ", ".join(sorted(parameters)))
    return fields
