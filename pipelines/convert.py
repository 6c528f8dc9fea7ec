"""Meshes and decks into decks and meshes, with a report of what the target cannot say."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from zrno.pipelines.merge import merge
from zrno.translators import Model, Report, read, settings, write
from zrno.translators.convert import to_particles
from zrno.translators.yaml_marks import Place


def convert(
    sources: Sequence[Path],
    target: Path,
    *,
    particles: str | None = None,
    spacing: float | None = None,
    parts: Sequence[str | int] = (),
    settings_file: Path | None = None,
    overrides: Mapping[str, Any] | None = None,
    numbers: Mapping[str, float] | None = None,
    dialect: str | None = None,
    strict: bool = False,
    allow_outside: bool = False,
) -> dict[str, Any]:
    """Translate files; returns the keys of `zrno convert --json` and `notes`.

    A mesh becomes particles where the target is a particle deck: particles, spacing, parts, settings_file and overrides
    (settings by dotted key) say how. numbers: parameters of a .geo script. dialect: of the .mcm that is written.
    strict: what the target cannot say is an error. allow_outside: files that a source includes may stand outside its
    folder. Raises InputError and ValueError; nothing is written then.
    """
    return translate(
        sources, target, particles=particles, spacing=spacing, parts=parts, settings_file=settings_file,
        overrides=overrides, numbers=numbers, dialect=dialect, strict=strict, allow_outside=allow_outside,
    )[0]  # fmt: skip


def translate(
    sources: Sequence[Path],
    target: Path,
    *,
    particles: str | None = None,
    spacing: float | None = None,
    parts: Sequence[str | int] = (),
    settings_file: Path | None = None,
    overrides: Mapping[str, Any] | None = None,
    places: Mapping[str, tuple[Place, Place]] | None = None,
    numbers: Mapping[str, float] | None = None,
    dialect: str | None = None,
    strict: bool = False,
    allow_outside: bool = False,
) -> tuple[dict[str, Any], settings.Settings | None]:
    """What `convert` does, and the settings that particles were made by. places: of the overrides (`settings.load`)."""
    model = merge([_read(source, numbers, allow_outside=allow_outside) for source in sources])
    if model.incomplete:
        raise ValueError("nothing can be made of a source that lacks what it names: " + "; ".join(model.incomplete[:5]))
    source = model.summary()
    report = Report()
    if len(sources) > 1:
        report.notes.append(f"{len(sources)} sources merged: ids of the second and later ones are offset")
    deck = target.suffix.lower() == ".mcm"
    makes_particles = deck and model.particles is None
    analysis = None
    if makes_particles:
        analysis = settings.load(settings_file, overrides=overrides, places=places)
        model, made = to_particles(model, analysis, particles or "solids", spacing, list(parts) or None)
        report.extend(made)
    elif particles or spacing or parts or settings_file or overrides:
        raise ValueError("--part, --particles, --spacing and --settings make a particle deck (.mcm) of a mesh")
    if dialect is not None and not deck:
        raise ValueError(f"{target}: a dialect is for .mcm decks")
    report.extend(_write(model, target, {} if dialect is None else {"dialect": dialect}, report if strict else None))
    result = {
        "source": source,
        "target": model.summary() | {"format": target.suffix.lower().lstrip(".")},
        **report.as_dict(),
        "notes": report.notes,
    }
    return result, analysis


def losses(result: Mapping[str, Any], *kinds: str) -> list[str]:
    """What was lost, a line each. kinds: approximated, dropped."""
    return [f"{kind}: {i['count']} {i['what']} - {i['where']}" for kind in kinds for i in result[kind]]


def report_text(result: Mapping[str, Any]) -> str:
    """Remarks, and what was approximated and dropped, a line each."""
    return "\n".join([*result["notes"], *losses(result, "approximated", "dropped")])


def _read(path: Path, numbers: Mapping[str, float] | None, *, allow_outside: bool) -> Model:
    if not numbers:
        return read(path, allow_outside=allow_outside)
    if path.suffix.lower() != ".geo":
        raise ValueError(f"{path}: numbers are parameters of a .geo script")
    from zrno.translators.gmsh.geo import read as read_geo

    return read_geo(path, numbers=numbers)


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
