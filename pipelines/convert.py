"""Meshes and decks into decks and meshes, with a report of what the target cannot say."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from zrno.translators import Model, Report, load_settings, read, write
from zrno.translators.convert import part_number, to_particles
from zrno.translators.fem import to_fem
from zrno.translators.merge import merge
from zrno.translators.particles import chosen_parts
from zrno.translators.rewire import keep_parts
from zrno.translators.settings import Settings


def convert(
    sources: Sequence[Path],
    target: Path,
    *,
    particles: str | None = None,
    spacing: float | None = None,
    parts: Sequence[str | int] = (),
    settings: Settings | None = None,
    numbers: Mapping[str, float] | None = None,
    dialect: str | None = None,
    msh: str | None = None,
    binary: bool = False,
    strict: bool = False,
    allow_outside: bool = False,
) -> dict[str, Any]:
    """Translate files; returns the keys of `zrno convert --json` and `notes`.

    A mesh becomes particles where the target is a particle deck (particles, spacing, parts and settings say how), and a
    finite element model where it is a FEM deck. parts: of any mesh, only these. numbers: parameters of a .geo script.
    dialect: of the .mcm that is written. msh, binary: version and encoding of the .msh that is written. strict: what
    the target cannot say is an error. allow_outside: files that a source includes may stand outside its folder. Raises
    InputError and ValueError; nothing is written then.
    """
    models = [read_source(source, numbers, allow_outside=allow_outside) for source in sources]
    lacking = [what for model in models for what in model.incomplete]
    if lacking:
        raise ValueError("nothing can be made of a source that lacks what it names: " + "; ".join(lacking[:5]))
    model = merge(models)
    source = model.summary()
    report = Report()
    if len(sources) > 1:
        report.notes.append(f"{len(sources)} sources merged: ids of the second and later ones are offset")
    kind = target.suffix.lower()
    if dialect is not None and kind != ".mcm":
        raise ValueError(f"{target}: a dialect is for .mcm decks")
    if (msh is not None or binary) and kind != ".msh":
        raise ValueError(f"{target}: --msh and --binary are for .msh meshes")
    options: dict[str, Any] = {} if dialect is None else {"dialect": dialect}
    options |= ({} if msh is None else {"version": msh}) | ({"binary": True} if binary else {})
    if kind == ".mcm" and model.particles is None:
        model, made = to_particles(model, settings or load_settings(), particles, spacing, list(parts) or None)
        report.extend(made)
    else:
        if particles or spacing:
            raise ValueError("--particles and --spacing make a particle deck (.mcm) of a mesh")
        if parts:
            model = _only(model, parts, report)
        if kind == ".dat" and (model.fem_control is None or settings is not None):
            model, made = to_fem(model, settings or load_settings())
            report.extend(made)
        elif settings is not None:
            raise ValueError("--settings make a deck (.mcm or .dat) of a mesh")
    report.extend(_write(model, target, options, report if strict else None))
    return {
        "source": source,
        "target": model.summary() | {"format": target.suffix.lower().lstrip(".")},
        **report.as_dict(),
        "notes": report.notes,
    }


def _only(model: Model, parts: Sequence[str | int], report: Report) -> Model:
    """The model with some of its parts."""
    if model.particles is not None:
        raise ValueError("--part takes parts of a mesh; a particle deck has none")
    wanted = chosen_parts(model, [part_number(model, part) for part in parts])
    left = [part.name or str(number) for number, part in model.parts.items() if number not in wanted]
    report.drop("parts", len(left), "not asked for: " + ", ".join(left[:20]))
    return keep_parts(model, np.array(wanted))


def losses(result: Mapping[str, Any], *kinds: str) -> list[str]:
    """What was lost, a line each. kinds: approximated, dropped."""
    return [f"{kind}: {i['count']} {i['what']} - {i['where']}" for kind in kinds for i in result[kind]]


def report_text(result: Mapping[str, Any]) -> str:
    """Remarks, and a table of what was translated, approximated and dropped."""
    rows = [("translated", count, what, "") for what, count in _contents(result["target"])]
    rows += [(kind, i["count"], i["what"], i["where"]) for kind in ("approximated", "dropped") for i in result[kind]]
    width = max((len(str(count)) for _, count, _, _ in rows), default=0)
    wide = min(max((len(what) for _, _, what, _ in rows), default=0), 40)
    table = [f"{kind:12} {count:>{width}}  {what:{wide}}  {where}".rstrip() for kind, count, what, where in rows]
    return "\n".join([*result["notes"], *table])


def _contents(summary: Mapping[str, Any]) -> list[tuple[str, int]]:
    """What is in a model, counted; what there is none of is left out."""
    counts = [("nodes", summary["nodes"]), *summary["elements"].items(), ("particles", summary["particles"])]
    counts += [(name, len(summary[name])) for name in ("parts", "materials", "sets")]
    return [(name, count) for name, count in counts if count]


def read_source(path: Path, numbers: Mapping[str, float] | None, *, allow_outside: bool) -> Model:
    """A file's model. numbers: parameters of a .geo script; else as in `convert`."""
    if not numbers:
        model = read(path, paired=True, allow_outside=allow_outside)
        return model if half_of_a_pair(model) else read(path, allow_outside=allow_outside)
    if path.suffix.lower() != ".geo":
        raise ValueError(f"{path}: numbers are parameters of a .geo script")
    from zrno.translators.gmsh.geo import read as read_geo

    return read_geo(path, numbers=numbers)


def half_of_a_pair(model: Model) -> bool:
    """Whether a particle deck is sound as half of a coupled pair alone: its last material owns no particle."""
    owners = model.particles
    return owners is None or not model.materials or not (owners.material == max(model.materials)).any()


def _write(model: Model, target: Path, options: dict[str, Any], strict: Report | None) -> Report:
    """Write the target; where nothing may be lost (strict: what is lost so far), only when nothing was."""
    if strict is None:
        return write(model, target, **options)
    with tempfile.TemporaryDirectory(dir=target.parent, prefix=".zrno-") as folder:
        draft = Path(folder) / target.name
        report = write(model, draft, **options)
        lost = [*strict.approximated, *strict.dropped, *report.approximated, *report.dropped]
        if lost:
            items = "; ".join(f"{item.count} {item.what} ({item.where})" for item in lost)
            raise ValueError(f"{target}: the target cannot say all (--strict): {items}")
        draft.replace(target)
    return report
