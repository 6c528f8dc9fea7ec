"""The command line: options in, one pipeline called, its answer out. Everything heavy is imported inside a command."""

from __future__ import annotations

import json as json_module
import sys
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from zrno.pipelines import console

app = typer.Typer(
    name="zrno",
    help="Grain, sand and ore against steel: from mesh to decks, runs, VTK series and pictures.",
    epilog="Exit codes: 0 done, 1 the run failed, 2 bad input, 3 something optional is not installed, 130 interrupted.",
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)
samples_app = typer.Typer(help="The shipped samples.", no_args_is_help=True, rich_markup_mode=None)
app.add_typer(samples_app, name="samples")

Json = Annotated[bool, typer.Option("--json", help="Print exactly one JSON object on stdout.")]
Verbose = Annotated[bool, typer.Option("-v", "--verbose", help="Show more, and where an error came from.")]
Quiet = Annotated[bool, typer.Option("-q", "--quiet", help="Print results and errors only.")]
AllowOutside = Annotated[bool, typer.Option("--allow-outside", help="Includes may leave the folder of their deck.")]
Directory = Annotated[Path, typer.Argument(metavar="DIR", help="A result folder.")]


class ParticleSource(StrEnum):
    """What particles are made of."""

    solids = "solids"
    shells = "shells"
    nodes = "nodes"


class Dialect(StrEnum):
    """Dialects of the .mcm deck."""

    v2_07 = "2.07"
    v2019_08 = "2019-08"
    v2019_10 = "2019-10"


class MshVersion(StrEnum):
    """Versions of the .msh mesh."""

    v4_1 = "4.1"
    v2_2 = "2.2"


def main() -> None:
    """The program `zrno`."""
    try:
        app()
    except SystemExit as stop:
        # Wrong usage is found before a command's body can answer.
        if stop.code == console.BAD_INPUT and "--json" in sys.argv and not console.answered():
            print(json_module.dumps({"status": "bad input", "errors": ["wrong usage: see the message on stderr"]}))
        raise


def _version(asked: bool) -> None:
    if asked:
        from zrno.pipelines.version import git_hash, version

        commit = git_hash()
        typer.echo(f"zrno {version()}" + (f" ({commit})" if commit else ""))
        raise typer.Exit


@app.callback()
def _zrno(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Version, commit.")
    ] = False,
) -> None:
    pass


def _help_settings(asked: bool) -> None:
    if asked:
        from zrno.translators.settings import help_settings

        typer.echo(help_settings(), nl=False)
        raise typer.Exit


@app.command()
def convert(
    paths: Annotated[list[Path], typer.Argument(metavar="SOURCE... TARGET", help="Files to read, the file to write.")],
    part: Annotated[list[str] | None, typer.Option(metavar="ID|NAME", help="Only this part; repeatable.")] = None,
    particles: Annotated[ParticleSource | None, typer.Option(help="What particles are made of.")] = None,
    spacing: Annotated[float | None, typer.Option(metavar="H", help="Of particles; default: the median edge.")] = None,
    settings: Annotated[Path | None, typer.Option(metavar="FILE.yaml", help="What a mesh does not carry.")] = None,
    dialect: Annotated[Dialect | None, typer.Option(help="Of the .mcm written.")] = None,
    msh: Annotated[MshVersion | None, typer.Option(help="Version of the .msh written; default: 4.1.")] = None,
    binary: Annotated[bool, typer.Option("--binary", help="Write the .msh in binary, not as text.")] = False,
    strict: Annotated[bool, typer.Option("--strict", help="What the target cannot say is an error.")] = False,
    allow_outside: AllowOutside = False,
    help_settings: Annotated[
        bool, typer.Option("--help-settings", callback=_help_settings, is_eager=True, help="List all settings.")
    ] = False,
    json: Json = False,
    verbose: Verbose = False,
    quiet: Quiet = False,
) -> None:
    """Translate meshes and decks; what the target cannot say is reported."""
    with console.command(typer.Exit, json=json, verbose=verbose, quiet=quiet) as out:
        from zrno.pipelines.convert import convert as run_convert
        from zrno.pipelines.convert import report_text
        from zrno.translators import load_settings

        if len(paths) < 2:
            raise ValueError("convert needs a source and a target: zrno convert SOURCE... TARGET")
        result = run_convert(
            paths[:-1],
            paths[-1],
            particles=particles.value if particles else None,
            spacing=spacing,
            parts=part or (),
            settings=load_settings(settings) if settings else None,
            dialect=dialect.value if dialect else None,
            msh=msh.value if msh else None,
            binary=binary,
            strict=strict,
            allow_outside=allow_outside,
        )
        out.note(report_text(result))
        out.answer(result, str(paths[-1]))


@app.command()
def info(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A mesh or a deck.")],
    allow_outside: AllowOutside = False,
    json: Json = False,
    verbose: Verbose = False,
    quiet: Quiet = False,
) -> None:
    """Show what is in a mesh or a deck."""
    with console.command(typer.Exit, json=json, verbose=verbose, quiet=quiet) as out:
        from zrno.pipelines.info import info as run_info
        from zrno.pipelines.info import info_text

        summary = run_info(file, allow_outside=allow_outside)
        out.answer(summary, info_text(file, summary))


@app.command()
def check(
    files: Annotated[list[Path], typer.Argument(metavar="FILE...", help="Meshes, decks, scenes.")],
    allow_outside: AllowOutside = False,
    json: Json = False,
    verbose: Verbose = False,
    quiet: Quiet = False,
) -> None:
    """Validate files: every fault with its place. Exit code 2 where there is one."""
    with console.command(typer.Exit, json=json, verbose=verbose, quiet=quiet) as out:
        from zrno.pipelines.check import check as run_check
        from zrno.pipelines.check import check_text, fault_lines

        rows = run_check(files, allow_outside=allow_outside)
        faults = fault_lines(rows)
        if faults:
            print("\n".join(faults), file=sys.stderr)
            out.code = console.BAD_INPUT
        out.answer({"files": rows, "faults": len(faults)}, check_text(rows))


@app.command()
def run(
    inputs: Annotated[list[Path], typer.Argument(metavar="DECK|SCENE...", help="A .mcm, a .dat, both, or a scene.")],
    output: Annotated[Path | None, typer.Option("-o", "--output", metavar="DIR", help="The result folder.")] = None,
    threads: Annotated[int | None, typer.Option(metavar="N", min=1, help="Default: all; few for small runs.")] = None,
    until: Annotated[float | None, typer.Option(metavar="T", help="Stop at this simulated time.")] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on from the last checkpoint of the folder.")] = False,
    options: Annotated[
        list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Override one value; repeatable, see below.")
    ] = None,
    allow_outside: AllowOutside = False,
    json: Json = False,
    verbose: Verbose = False,
    quiet: Quiet = False,
) -> None:
    """Run decks or a scene; write series, history, checkpoints and pictures.

    --set takes, values written as in YAML:

    a key of the scene, dotted (output.every=5, coupling.friction.static=0.5, render.0.field=pressure);

    a key of its meshes, for all of them (spacing=0.05, particles=nodes, dialect=2.07, numbers.length=6);

    a setting, dotted (end_time=20, materials.left.E=0.7: `zrno convert --help-settings` lists them): the scene's
    meshes are made with it; of a deck that is there already it replaces the field (control fields and viscosity);

    compat=original: the original programs' results where they differ from ours.
    """
    with console.command(typer.Exit, json=json, verbose=verbose, quiet=quiet) as out:
        from zrno.pipelines.options import parse
        from zrno.pipelines.run import run as run_inputs

        result = run_inputs(
            inputs,
            output=output,
            threads=threads,
            until=until,
            resume=resume,
            options=parse(options or ()),
            quiet=quiet,
            progress=out.progress,
            allow_outside=allow_outside,
            known=out.known,
        )
        text = f"{result['status']}: {result['steps']} steps to t = {result['time']:g}, {result['output']}"
        out.answer(result, "\n".join([text, *result.get("pictures", ())]))


def _size(text: str) -> tuple[int, int]:
    width, _, height = text.lower().partition("x")
    if not (width.isdigit() and height.isdigit()):
        raise typer.BadParameter(f"{text} is no size; expected WIDTHxHEIGHT in pixels, e.g. 1280x720")
    return int(width), int(height)


@app.command()
def render(
    directory: Directory,
    output: Annotated[Path | None, typer.Option("-o", "--output", metavar="FILE", help="FILE.png or FILE.mp4.")] = None,
    field: Annotated[str, typer.Option(metavar="NAME", help="An array, or a component: velocity_x.")] = "von_mises",
    time: Annotated[str, typer.Option(metavar="T|last|all", help="A simulated time, the last, or all.")] = "last",
    view: Annotated[
        str, typer.Option(metavar="VIEW", help="iso, x, y, z, -x, -y, -z, or towards the camera: 1,-2,0.5.")
    ] = "iso",
    size: Annotated[str, typer.Option(metavar="WxH", help="Pixels.")] = "1280x720",
    of: Annotated[
        str | None, typer.Option(metavar="particles|elements", help="What has the colours; else all with the field.")
    ] = None,
    most: Annotated[float | None, typer.Option(metavar="VALUE", help="Where the colours end.")] = None,
    json: Json = False,
    verbose: Verbose = False,
    quiet: Quiet = False,
) -> None:
    """Draw the particles and elements of a result folder, coloured by a field."""
    pixels = _size(size)
    with console.command(typer.Exit, json=json, verbose=verbose, quiet=quiet) as out:
        from zrno.pipelines.render import render as run_render

        files = run_render(directory, output=output, field=field, time=time, view=view, size=pixels, of=of, most=most)
        out.answer({"files": [str(f) for f in files]}, "\n".join(map(str, files)))


@app.command()
def plot(
    directory: Directory,
    output: Annotated[Path | None, typer.Option("-o", "--output", metavar="FILE.png", help="The picture.")] = None,
    quantity: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="A column of history.csv; repeatable.")
    ] = None,
    json: Json = False,
    verbose: Verbose = False,
    quiet: Quiet = False,
) -> None:
    """Plot the histories of a result folder against time."""
    with console.command(typer.Exit, json=json, verbose=verbose, quiet=quiet) as out:
        from zrno.pipelines.plot import plot as run_plot

        file = run_plot(directory, output=output, quantities=quantity)
        out.answer({"file": str(file)}, str(file))


@app.command()
def study(
    scene: Annotated[Path, typer.Argument(metavar="SCENE", help="A scene with a section `study`.")],
    output: Annotated[Path | None, typer.Option("-o", "--output", metavar="DIR", help="The study's folder.")] = None,
    repeat: Annotated[int, typer.Option(metavar="N", min=1, help="Time each run N times; the median counts.")] = 1,
    threads: Annotated[int | None, typer.Option(metavar="N", min=1, help="Default: all; few for small runs.")] = None,
    options: Annotated[
        list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="For every run, as `run` takes it.")
    ] = None,
    allow_outside: AllowOutside = False,
    json: Json = False,
    verbose: Verbose = False,
    quiet: Quiet = False,
) -> None:
    """Run a scene over resolutions and options: error against wall time, and the cheapest setting that will do.

    Writes study.csv, study.json and study.png, and a result folder a run in DIR/runs; called again, it runs only what
    is missing or was made of other inputs.
    """
    with console.command(typer.Exit, json=json, verbose=verbose, quiet=quiet) as out:
        from zrno.pipelines.options import parse
        from zrno.pipelines.study import study as run_study
        from zrno.pipelines.study_table import study_text

        result = run_study(
            scene,
            output=output,
            repeat=repeat,
            threads=threads,
            options=parse(options or ()),
            allow_outside=allow_outside,
            progress=out.progress,
            known=out.known,
        )
        out.code = 0 if any(row["error"] is not None for row in result["rows"]) else console.FAILED
        out.answer(result, study_text(result))


@samples_app.command("list")
def samples_list(json: Json = False, verbose: Verbose = False, quiet: Quiet = False) -> None:
    """List the shipped samples."""
    with console.command(typer.Exit, json=json, verbose=verbose, quiet=quiet) as out:
        from zrno.pipelines.samples import names

        found = names()
        out.answer({"samples": found}, "\n".join(f"{name:<20}{title}" for name, title in found.items()))


@samples_app.command("copy")
def samples_copy(
    name: Annotated[str, typer.Argument(metavar="NAME", help="One of `zrno samples list`.")],
    directory: Annotated[Path | None, typer.Argument(metavar="[DIR]", help="Default: a folder of its name.")] = None,
    json: Json = False,
    verbose: Verbose = False,
    quiet: Quiet = False,
) -> None:
    """Copy a sample to a folder, to run and to change it."""
    with console.command(typer.Exit, json=json, verbose=verbose, quiet=quiet) as out:
        from zrno.pipelines.samples import copy

        target = copy(name, directory)
        out.answer({"sample": name, "directory": str(target)}, str(target))


@app.command()
def doctor(json: Json = False, verbose: Verbose = False, quiet: Quiet = False) -> None:
    """Show what this machine can do, with hints. Exit code 3 where runs or pictures lack something."""
    with console.command(typer.Exit, json=json, verbose=verbose, quiet=quiet) as out:
        from zrno.pipelines.doctor import as_dict, doctor_text, examine

        findings = examine()
        answer = as_dict(findings)
        out.answer(answer, doctor_text(findings))
        out.code = 0 if answer["ok"] else console.NOT_INSTALLED
