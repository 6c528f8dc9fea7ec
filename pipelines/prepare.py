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
from zrno.pipelines.coupling_method import Coupling
from zrno.pipelines.coupling_method import of_options as coupling_of_options
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
    from zrno.solvers import coupling, fem, sph

    Solver = sph.Solver | fem.Solver | coupling.Coupled

OF_DECKS = ("sph.", "fem.", "coupling.")  # sections of a scene that go with bare decks too


@dataclass(frozen=True, slots=True)
class Prepared:
    """A run that can begin. decks: at their places, SHA-256 of each in digest; models: of each, the particles' first;
    made: what `convert` returns of each deck made.

    state: the checkpoint that the solver stands at, None at the start; started: when the deck had been read
    (`time.perf_counter`); compiled: seconds that the process had spent compiling by then; listing: whether a
    structure's steps are listed as text.
    """

    scene: Scene | None
    decks: list[Path]
    digest: dict[str, str]
    models: list[Model]
    made: list[dict[str, Any]]
    solver: Solver
    state: Mapping[str, Any] | None
    started: float
    compiled: float
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
    from zrno.solvers.jit import compile_seconds

    scene, decks = _decks(paths, chosen)
    paired = check_decks(decks)
    if scene is not None and scene.coupling is not None and len(decks) == 1:
        message = "coupling is of grain and structure, and this scene has one deck"
        expected = "two decks; bodies of one deck meet by sph.contact"
        raise InputError([scene.fault(("coupling",), message, expected, key=True)])
    if directory.exists() and not directory.is_dir():
        raise InputError([Fault(str(directory), 1, 1, "not a folder", expected="a folder for the results")])
    made: Sequence[Draft]
    making = drafts(scene, paths[0].parent, publishing=True, allow_outside=allow_outside) if scene else nullcontext(())
    with making as made:
        models, places, digest = [], {}, {}
        for deck in decks:
            draft = next((draft for draft in made if draft.target == deck), None)
            model = draft.read(paired=paired) if draft else read(deck, paired=paired)
            if draft and model.particle_control is not None:
                places = draft.places(model)
            if scene is None and (model.particle_control is not None or not paired):
                places = command_options.apply(chosen.settings, model)
            models.append(model)
            digest[str(deck)] = next(iter(digests([draft.path if draft else deck]).values()))
        started, compiled = time.perf_counter(), compile_seconds()
        try:
            solver = _solver(models, decks, scene, chosen, places, threads)
        except ValueError as error:  # things that do not go together
            if isinstance(error, InputError):
                raise
            raise InputError([Fault(str(decks[0]), 1, 1, str(error))]) from error
        state = load_latest(directory, inputs=digest) if resume else None
        if state is not None:
            solver.restore(dict(state))
        if scene is not None:
            _check_pictures(scene, solver)
        directory.mkdir(parents=True, exist_ok=True)
        for draft in made:
            draft.publish()
        listed = models[-1].fem_control is not None and _of_structure(scene, chosen).listing
        made_of = [d.result for d in made]
        return Prepared(scene, decks, digest, models, made_of, solver, state, started, compiled, listed)


def _solver(
    models: Sequence[Model],
    decks: Sequence[Path],
    scene: Scene | None,
    chosen: command_options.Options,
    places: Mapping[str, Place],
    threads: int | None,
) -> Solver:
    """The solver of a deck: finite elements of a .dat, particles of an .mcm, both together of a pair."""
    original = chosen.run.get("compat") == "original"
    of_structure = _of_structure(scene, chosen)
    of_particles = scene.sph if scene else of_options(_section(chosen, "sph"))
    if len(models) == 2:
        from zrno.pipelines.build_coupled import coupled_problem
        from zrno.solvers import sph
        from zrno.solvers.coupling import Coupled

        how = (scene.coupling or Coupling()) if scene else coupling_of_options(_section(chosen, "coupling"))
        particles, structure, exchange = coupled_problem(
            models[0], models[1], (str(decks[0]), str(decks[1])), how, places=places, original=original,
            of_particles=of_particles, of_structure=of_structure,
        )  # fmt: skip
        # One thread unless asked: those of PARDISO keep their processors busy for a while after each answer.
        steel = _structure(structure, models[1], decks[1], threads or 1)
        return Coupled(steel, sph.Solver(particles, threads=threads), exchange)
    model, deck = models[0], decks[0]
    if model.fem_control is not None:
        from zrno.pipelines.build_fem import structure_problem

        return _structure(structure_problem(model, str(deck), of_structure), model, deck, threads)
    from zrno.pipelines.build import particle_problem
    from zrno.solvers import sph

    problem = particle_problem(model, str(deck), places=places, original=original, method=of_particles)
    return sph.Solver(problem, threads=threads)


def _structure(problem: fem.Problem, model: Model, deck: Path, threads: int | None) -> fem.Solver:
    """The solver of a structure; what cannot be set up is a fault of its deck."""
    from zrno.solvers import fem

    try:
        return fem.Solver(problem, threads=threads)
    except fem.Bad as error:
        raise InputError([Fault(str(deck), 1, 1, f"element {error.element}: {error.cause}")]) from error
    except fem.Mechanism as error:
        number = int(model.node_ids[error.node])
        raise InputError([Fault(str(deck), 1, 1, f"node {number}: {error}")]) from error


def _of_structure(scene: Scene | None, chosen: command_options.Options) -> Fem:
    return scene.fem if scene else fem_of_options(_section(chosen, "fem"))


def _section(chosen: command_options.Options, name: str) -> dict[str, Any]:
    """The options of a section of the scene."""
    return {key: value for key, value in chosen.scene.items() if key.startswith(f"{name}.")}


def check_decks(decks: list[Path]) -> bool:
    """Whether decks are a pair, the particles' then first. Raises InputError for what makes no run."""
    kinds = [deck.suffix.lower() for deck in decks]
    if len(decks) == 1:
        return False
    if sorted(kinds) != [".dat", ".mcm"]:
        said = ", ".join(deck.name for deck in decks)
        expected = "one .mcm, one .dat, one of each (coupled), or one scene"
        raise InputError([Fault(str(decks[-1]), 1, 1, "these do not make a run", said, expected)])
    decks.sort(key=lambda deck: deck.suffix.lower() != ".mcm")
    return True


def _decks(paths: Sequence[Path], chosen: command_options.Options) -> tuple[Scene | None, list[Path]]:
    """The scene, if one was given, and the decks."""
    if len(paths) == 1 and paths[0].suffix.lower() in scenes.SUFFIXES:
        scene = scenes.load(paths[0], chosen.scene)
        return scene, [paths[0].parent / deck for deck in scene.decks]
    unused = [key for key in chosen.scene if key not in chosen.settings and not key.startswith(OF_DECKS)]
    if unused:
        raise InputError([Fault("--set", 1, 1, f"{key} is for scenes", key, "a scene") for key in unused])
    return None, list(paths)


def _check_pictures(scene: Scene, solver: Solver) -> None:
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
