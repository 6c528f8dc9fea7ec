"""Run decks or a scene: from files to a result folder with series, history, checkpoints and pictures."""

from __future__ import annotations

import logging
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zrno.pipelines import options as command_options
from zrno.pipelines.balance import Balance
from zrno.pipelines.checkpoint import Checkpointer
from zrno.pipelines.convert import losses
from zrno.pipelines.errors import Missing, RunFailed
from zrno.pipelines.history import History
from zrno.pipelines.interrupt import held_back
from zrno.pipelines.listing import Listing
from zrno.pipelines.manifest import Manifest, digests
from zrno.pipelines.prepare import prepare
from zrno.pipelines.progress import Progress
from zrno.pipelines.scene import Scene
from zrno.pipelines.series import ResultSeries
from zrno.translators.control import FemControl
from zrno.translators.model import Model
from zrno.translators.text import Fault, InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from zrno.solvers.time import Observer

FRAMES = 20  # frames of a run whose deck names no interval
SAVES = 20  # checkpoints of a structure's run, where the scene says nothing
ROWS = 10  # rows of history a frame, where the deck names no interval for them

log = logging.getLogger("zrno")


def run(
    inputs: Sequence[Path | str],
    *,
    output: Path | str | None = None,
    threads: int | None = None,
    until: float | None = None,
    resume: bool = False,
    options: Mapping[str, Any] | None = None,
    quiet: bool = True,
    progress: bool = False,
    allow_outside: bool = False,
    known: dict[str, Any] | None = None,
) -> dict[str, Any]:
    """Run one particle deck or a scene; returns the keys of `zrno run --json`.

    output: result folder (default: the input's name and `_results`, in the working folder). threads: None for all, or
    one for few particles. until: stop at this simulated time. resume: go on from the newest checkpoint of the folder,
    if it has one. options: by dotted key, as `--set` takes them (`compat=original`, scene keys, settings). quiet: no
    warnings on stderr at the end; progress: a bar there. known: takes the
    same keys as they become known, also of a run that fails. allow_outside: files that a scene's meshes include may
    stand outside their folders.

    Raises InputError for bad input (nothing is written then), `Diverged` or `RunFailed` for a run that cannot go on,
    KeyboardInterrupt after the checkpoint of an interrupted one.
    """
    chosen = command_options.split(options or {})
    if until is not None and not until >= 0.0:
        raise InputError([Fault("--until", 1, 1, "the run cannot end before it starts", str(until), "0 or more")])
    paths = [Path(p) for p in inputs]
    directory = Path(output) if output is not None else Path(f"{paths[0].stem}_results")
    known = {} if known is None else known
    known |= {"steps": 0, "time": 0.0}
    ready = prepare(paths, chosen, directory, threads=threads, resume=resume, allow_outside=allow_outside)
    scene, solver, state = ready.scene, ready.solver, ready.state
    model = ready.models[0]
    count = _counts(ready.models)

    from zrno.solvers.jit import compile_seconds
    from zrno.solvers.time import run as run_to_end

    end = solver.problem.end_time
    end = end if until is None else min(end, until)

    series, history, checkpointer = _observers(
        ready.models, scene, directory, end, ready.digest, resume=state is not None
    )
    bar = Progress(end, show=progress)
    original = chosen.run.get("compat") == "original"
    factor = getattr(solver.problem, "step_factor", None)
    balance = Balance(interval=history.interval, step_factor=factor, original=original)
    watchers: list[Observer] = [series, history, checkpointer, balance, bar]
    if ready.listing:
        watchers.append(Listing(directory, model.title, resume=state is not None))
    result: dict[str, Any] = {}
    with _log_file(directory, append=state is not None):
        manifest = Manifest(
            directory,
            inputs=digests([*paths, *ready.decks]),
            options=_all_options(scene, ready.models, chosen, until),
            threads=solver.threads,
            title=(scene.title if scene else "") or model.title,
            units=scene.units if scene else None,
            dimension=solver.problem.dimension,
            axisymmetric=getattr(solver.problem, "axisymmetric", False),
        )
        for mesh, report in zip(scene.meshes if scene else (), ready.made, strict=True):
            for line in [*report["notes"], *losses(report, "approximated", "dropped")]:
                log.info("making %s: %s", mesh.target, line)
        warnings = list(dict.fromkeys(warning for m in ready.models for warning in m.warnings))
        for warning in warnings:
            log.warning(warning)
        warnings += [line for report in ready.made for line in losses(report, "dropped")]
        names = " and ".join(deck.name for deck in ready.decks)
        log.info("%s: %s, end time %g; built for %s", names, _counted(count), end, solver.kernels())
        if state is not None:
            log.info("resumed at t = %g, step %d", solver.time, solver.step)
        steps_before = _steps(solver)
        status = "failed"
        loop = time.perf_counter()
        try:
            with held_back() as interrupt:
                run_to_end(solver, [*watchers, interrupt], end)
            status = "done"
        except KeyboardInterrupt:
            status = "interrupted"
            if interrupt.raised:
                checkpointer.save(solver)
            log.warning("interrupted at t = %g, step %d; --resume goes on", solver.time, solver.step)
            raise
        except Exception as error:
            log.error("%s", error)
            if isinstance(error, OSError):  # a full disk is no bad input
                raise RunFailed(str(error)) from error
            raise
        finally:
            bar.finish(solver)
            history.close()
            seconds = time.perf_counter() - loop
            result = {
                "status": status,
                "steps": solver.step,
                "time": solver.time,
                "wall_seconds": time.perf_counter() - ready.started,
                "compile_seconds": compile_seconds() - ready.compiled,
                **count,
                "particle_steps_per_second": count["particles"] * (_steps(solver) - steps_before) / max(seconds, 1e-9),
                "energy": solver.energy_report(),
                "output": str(directory),
                "warnings": list(warnings),
            }
            unbalanced = balance.warning(solver)
            if unbalanced is not None:
                log.warning(unbalanced)
                result["warnings"].append(unbalanced)
            known |= result
            manifest.update(**result)
        speed = f"{result['particle_steps_per_second']:.3g} particle-steps/s, " if result["particles"] else ""
        log.info(
            "done: %d steps to t = %g in %.2f s (%scompiling %.1f s), energy balance error %.2e",
            solver.step, solver.time, seconds, speed, result["compile_seconds"], result["energy"]["balance_error"],
        )  # fmt: skip
        if hasattr(solver, "seconds"):
            log.info("budget: %s", _budget(solver, seconds))
        result["pictures"] = _pictures(scene, directory, result["warnings"])
        manifest.update(warnings=result["warnings"], pictures=result["pictures"])
    if not quiet:
        for warning in result["warnings"]:
            print(f"warning: {warning}", file=sys.stderr)
    return result


def _observers(
    models: Sequence[Model], scene: Scene | None, directory: Path, end: float, decks: Mapping[str, str], *, resume: bool
) -> tuple[ResultSeries, History, Checkpointer]:
    model = models[0]
    control = model.particle_control
    if control is None or len(models) == 2:
        return _step_observers(models, scene, directory, decks, resume=resume)
    frames = (scene.output.every if scene else None) or control.output_interval or max(end, 1e-300) / FRAMES
    rows = control.history_interval or frames / ROWS
    saves = scene.checkpoint.every if scene and scene.checkpoint else frames
    units = scene.system.labels(3 if control.axisymmetric else control.dimension) if scene and scene.system else {}
    return (
        ResultSeries(
            directory,
            {i: m.name for i, m in model.materials.items()},
            interval=frames,
            format=scene.output.format if scene else "vtp",
            resume=resume,
        ),
        History(directory, interval=rows, units=units, resume=resume),
        Checkpointer(directory, interval=saves, inputs=decks),
    )


def _step_observers(
    models: Sequence[Model], scene: Scene | None, directory: Path, decks: Mapping[str, str], *, resume: bool
) -> tuple[ResultSeries, History, Checkpointer]:
    """Of a structure, alone or with particles: a row and a frame a step, or the steps that the deck plots."""
    fem = models[-1].fem_control
    assert fem is not None
    names = {i: m.name for i, m in models[0].materials.items()}
    if len(models) == 2:  # the structure's materials follow the particles'
        assert models[0].particles is not None
        last = int(models[0].particles.material.max())
        names = {i: name for i, name in names.items() if i <= last or i - last not in models[1].materials}
        names |= {last + i: m.name or models[0].materials.get(last + i, m).name for i, m in models[1].materials.items()}
    every = scene.output.every if scene else None
    steps = sum(count for count, _ in fem.periods) or 1
    saves = scene.checkpoint.every if scene and scene.checkpoint else None
    return (
        ResultSeries(
            directory,
            names,
            interval=every,
            format=scene.output.format if scene else "vtp",
            resume=resume,
            wanted=None if every else _plotted(fem),
        ),
        History(
            directory, interval=None, units=scene.system.labels(3) if scene and scene.system else {}, resume=resume
        ),
        Checkpointer(directory, interval=saves, every=max(1, steps // SAVES), inputs=decks),
    )


def _plotted(fem: FemControl) -> Callable[[int], bool]:
    """Whether a deck plots a step: in one of its blocks (first, increment, last), else every so many."""
    blocks = fem.plot_blocks
    if blocks:
        return lambda step: step == 0 or any(a <= step <= c and (step - a) % max(b, 1) == 0 for a, b, c, _ in blocks)
    return lambda step: True


def _counts(models: Sequence[Model]) -> dict[str, int]:
    return {
        "particles": sum(m.particle_count() for m in models),
        "nodes": sum(len(m.xyz) for m in models),
        "elements": sum(sum(m.element_counts().values()) for m in models),
    }


def _counted(count: Mapping[str, int]) -> str:
    return ", ".join(f"{number} {name}" for name, number in count.items() if number)


def _budget(solver: Any, total: float) -> str:
    """Where the time of a coupled run went."""
    own = {**solver.seconds, "output and the rest": total - sum(solver.seconds.values())}
    steps = {"structure": f" ({solver.step} steps)", "particles": f" ({_steps(solver)} steps)"}
    return ", ".join(f"{name}{steps.get(name, '')} {spent:.1f} s" for name, spent in own.items())


def _steps(solver: Any) -> int:
    """Steps of the particles, where there are some."""
    return int(getattr(solver, "particles", solver).step)


def _all_options(
    scene: Scene | None, models: Sequence[Model], chosen: command_options.Options, until: float | None
) -> dict[str, Any]:
    from dataclasses import asdict

    control: dict[str, Any] = {}
    for said in [c for m in models for c in (m.particle_control, m.fem_control) if c]:
        control |= asdict(said)
    control.pop("places", None)
    return {
        "scene": scene.model_dump() if scene else None,
        "control": control,
        "compat": chosen.run.get("compat"),
        "until": until,
    }


def _pictures(scene: Scene | None, directory: Path, warnings: list[str]) -> list[str]:
    """The pictures that a scene asks for. The run is done whether they can be drawn or not: that is a warning."""
    drawn: list[str] = []
    for i, picture in enumerate(scene.render if scene else ()):
        from zrno.pipelines.render import render

        try:
            files = render(directory, **picture.model_dump())
            drawn += [str(file) for file in files]
        except (Missing, ValueError) as error:
            warnings.append(f"render.{i} is not drawn: {error}")
            log.warning(warnings[-1])
            if isinstance(error, Missing):  # as for all others
                break
    return drawn


@contextmanager
def _log_file(directory: Path, *, append: bool) -> Iterator[None]:
    """run.log of a result folder, for as long as the run lasts."""
    directory.mkdir(parents=True, exist_ok=True)
    handler = logging.FileHandler(directory / "run.log", mode="a" if append else "w", encoding="utf-8")
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
    log.addHandler(handler)
    log.setLevel(logging.INFO)
    try:
        yield
    finally:
        log.removeHandler(handler)
        handler.close()
