"""What a run needs before its first step: read, made, checked. Until all of it is sound, nothing is written."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zrno.pipelines import options as command_options
from zrno.pipelines import scene as scenes
from zrno.pipelines.checkpoint import load_latest
from zrno.pipelines.drafts import Draft, drafts
from zrno.pipelines.fem_method import Fem
from zrno.pipelines.fem_method import of_options as fem_of_options
from zrno.pipelines.manifest import digests
from zrno.pipelines.method import of_options
from zrno.pipelines.quantities import shown_names
from zrno.pipelines.scene import Scene
from zrno.translators import read
from zrno.translators.model import Model
from zrno.translators.text import Fault, InputError
from zrno.translators.yaml_marks import Place, did_you_mean

if TYPE_CHECKING:
    from zrno.solvers import fem, sph


@dataclass(frozen=True, slots=True)
class Prepared:
    """A run that can begin. deck: at its place, its SHA-256 in digest; made: what `convert` returns of each deck made.

    state: the checkpoint that the solver stands at, None at the start; started: when the deck had been read
    (`time.perf_counter`); listing: whether a structure's steps are listed as text.
    """

    scene: Scene | None
    deck: Path
    digest: dict[str, str]
    model: Model
    made: list[dict[str, Any]]
    solver: sph.Solver | fem.Solver
    state: Mapping[str, Any] | None
    started: float
    listing: bool


def prepare(
    paths: Sequence[Path],
    chosen: command_options.Options,
    directory: Path,
    *,
    threads: int | None = None,
    resume: bool = False,
    allow_outside: bool = False,
) -> Prepared:
    """Read the inputs of a run and build its solver; then make the result folder, and put decks in their places.

    Raises InputError for bad input, ValueError for a checkpoint that does not fit.
    """
    scene, decks = _decks(paths, chosen)
    refuse_what_is_not_run(decks)
    if scene is not None and scene.coupling is not None and len(decks) == 1:
        message = "coupling is of grain and structure, and this scene has one deck"
        expected = "two decks; bodies of one deck meet by sph.contact"
        raise InputError([scene.fault(("coupling",), message, expected, key=True)])
    if directory.exists() and not directory.is_dir():
        raise InputError([Fault(str(directory), 1, 1, "not a folder", expected="a folder for the results")])
    made: Sequence[Draft]
    making = drafts(scene, paths[0].parent, publishing=True, allow_outside=allow_outside) if scene else nullcontext(())
    with making as made:
        deck = decks[0]
        draft = next((draft for draft in made if draft.target == deck), None)
        model = draft.read() if draft else read(deck)
        started = time.perf_counter()
        places = draft.places(model) if draft else {}
        if scene is None:
            places = command_options.apply(chosen.settings, model)
        digest = {str(deck): next(iter(digests([draft.path if draft else deck]).values()))}
        try:
            solver = _solver(model, deck, scene, chosen, places, threads)
        except ValueError as error:  # things that do not go together
            if isinstance(error, InputError):
                raise
            raise InputError([Fault(str(deck), 1, 1, str(error))]) from error
        state = load_latest(directory, inputs=digest) if resume else None
        if state is not None:
            solver.restore(dict(state))
        if scene is not None:
            _check_pictures(scene, solver)
        directory.mkdir(parents=True, exist_ok=True)
        for draft in made:
            draft.publish()
        return Prepared(scene, deck, digest, model, [d.result for d in made], solver, state, started,
                        model.fem_control is not None and _of_structure(scene, chosen).listing)  # fmt: skip


def _solver(
    model: Model,
    deck: Path,
    scene: Scene | None,
    chosen: command_options.Options,
    places: Mapping[str, Place],
    threads: int | None,
) -> sph.Solver | fem.Solver:
    """The solver of a deck: finite elements of a .dat, particles of an .mcm."""
    if model.fem_control is not None:
        from zrno.pipelines.build_fem import structure_problem
        from zrno.solvers import fem

        problem = structure_problem(model, str(deck), _of_structure(scene, chosen))
        try:
            return fem.Solver(problem, threads=threads)
        except fem.Bad as error:
            raise InputError([Fault(str(deck), 1, 1, f"element {error.element}: {error.cause}")]) from error
        except fem.Mechanism as error:
            number = int(model.node_ids[error.node])
            raise InputError([Fault(str(deck), 1, 1, f"node {number}: {error}")]) from error
    from zrno.pipelines.build import particle_problem
    from zrno.solvers import sph

    method = scene.sph if scene else of_options(_section(chosen, "sph"))
    original = chosen.run.get("compat") == "original"
    particles = particle_problem(model, str(deck), places=places, original=original, method=method)
    return sph.Solver(particles, threads=threads)


def _of_structure(scene: Scene | None, chosen: command_options.Options) -> Fem:
    return scene.fem if scene else fem_of_options(_section(chosen, "fem"))


def _section(chosen: command_options.Options, name: str) -> dict[str, Any]:
    """The options of a section of the scene."""
    return {key: value for key, value in chosen.scene.items() if key.startswith(f"{name}.")}


def refuse_what_is_not_run(decks: Sequence[Path]) -> None:
    """Refuse what later versions will run. Raises InputError."""
    if len(decks) != 1:
        raise InputError([Fault(str(decks[-1]), 1, 1, "one run takes one deck", "", "one .mcm, one .dat or one scene")])


def _decks(paths: Sequence[Path], chosen: command_options.Options) -> tuple[Scene | None, list[Path]]:
    """The scene, if one was given, and the decks."""
    if len(paths) == 1 and paths[0].suffix.lower() in scenes.SUFFIXES:
        scene = scenes.load(paths[0], chosen.scene)
        return scene, [paths[0].parent / deck for deck in scene.decks]
    unused = [key for key in chosen.scene if key not in chosen.settings and not key.startswith(("sph.", "fem."))]
    if unused:
        raise InputError([Fault("--set", 1, 1, f"{key} is for scenes", key, "a scene") for key in unused])
    return None, list(paths)


def _check_pictures(scene: Scene, solver: sph.Solver | fem.Solver) -> None:
    """The fields that a scene's pictures show are fields of this solver's frames. Raises InputError."""
    if not scene.render:
        return
    names = shown_names(solver.frame())
    faults = [
        scene.fault(("render", i, "field"), f"render.{i}.field: no such field", did_you_mean(picture.field, names))
        for i, picture in enumerate(scene.render)
        if picture.field not in names
    ]
    if faults:
        raise InputError(faults)
