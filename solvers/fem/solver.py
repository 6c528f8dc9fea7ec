"""The finite element solver: takes the steps of a problem, shows its state, keeps and restores it."""

from __future__ import annotations

import logging
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import Diverged
from ..frame import Frame
from . import output
from .assembly import AXES, Assembly, Mechanism
from .equilibrium import NotConverged, Target, equilibrium
from .loads import Loads
from .problem import SMALL, Problem
from .shape import Shape

Floats = NDArray[np.float64]
log = logging.getLogger("zrno")


class Solver:
    """A structure in time. What a step is, the problem says: static, linear or not."""

    def __init__(self, problem: Problem, *, threads: int | None = None) -> None:
        self.problem = problem
        self.threads = threads or 1
        self.assembly = Assembly(problem, threads=self.threads)
        self.loads = Loads(problem, self.assembly.groups)
        n = len(problem.x)
        finite = any(e.geometry != SMALL and e.family in ("shell", "beam") for e in problem.elements)
        turn = np.broadcast_to(np.eye(3), (n, 3, 3)).copy() if finite else None
        self.shape = Shape(np.zeros((n, 6)), turn)
        self.linear = output.is_linear(problem)
        self.time, self.step, self.dt = 0.0, 0, problem.steps[0][1]
        self.reaction = np.zeros((n, 6))
        self.internal_forces, self.external_forces = np.zeros((n, 6)), np.zeros((n, 6))
        self.external_work = 0.0
        self.iterations = 0
        self._patterns: list[tuple[int | None, float, Floats, Floats]] | None = None
        self._ends = problem.ends()

    def kernels(self) -> str:
        """What a run is built of, for the log."""
        kinds = ", ".join(f"{len(e.ids)} {e.kind} {e.family}" for e in self.problem.elements)
        how = "linear" if self.linear else f"nonlinear ({self.problem.iteration.method})"
        return f"{kinds}; {self.assembly.equations} equations by {self.assembly.system.name}; {how} static"

    @property
    def n(self) -> int:
        """Nodes."""
        return len(self.problem.x)

    def advance(self, until: float, max_steps: int, pause: float = math.inf) -> None:
        """Take one of the problem's steps, and come back: each is to be seen. A step that passes `until` is taken whole.

        Raises Diverged with the step, where, and the likely cause; the state is the last one in equilibrium.
        """
        if max_steps > 0 and self.time < until and self.step + 1 < len(self._ends):
            self._take(float(self._ends[self.step + 1]))

    def _take(self, end: float) -> None:
        dt = end - self.time
        try:
            if self.linear:
                self._linear(end)
            else:
                self._nonlinear(end)
        except Mechanism as error:
            raise self._diverged(str(error), (error.node, error.dof) if error.node >= 0 else None) from error
        except NotConverged as error:
            raise self._diverged(error.cause, error.worst) from error
        self.step += 1
        self.time, self.dt = end, dt

    def _diverged(self, cause: str, where: tuple[int, int] | None) -> Diverged:
        if where is None:
            return Diverged(self.step, 0, cause)
        number = int(self.problem.node_ids[where[0]])
        return Diverged(self.step, 0, f"{cause} at node {number} along {AXES[where[1]]}")

    # linear

    def _linear(self, end: float) -> None:
        """Superpose the answers to each pattern of loads and motions: they are found once."""
        if self._patterns is None:
            self._patterns = self._answers()
        u, external = np.zeros((self.n, 6)), np.zeros((self.n, 6))
        for curve, shift, forces, answer in self._patterns:
            factor = self.loads.factor(curve, end + shift)
            u += factor * answer
            external += factor * forces
        self._accept(Shape(u), external, self.time)

    def _answers(self) -> list[tuple[int | None, float, Floats, Floats]]:
        a, zero = self.assembly, Shape(np.zeros((self.n, 6)))
        motions: dict[int | None, Floats] = {}
        for m in self.problem.motions:
            motions.setdefault(m.curve, np.zeros((self.n, 6)))[m.nodes, m.dofs] = m.values
        a.evaluate(zero, zero, 0.0)
        a.factor()
        cases = [(curve, shift, forces) for curve, shift, forces in self.loads.patterns()]
        answers = []
        if cases:
            right = np.column_stack([a.gather(forces) for _, _, forces in cases])
            found = a.solve(np.asfortranarray(right))
            answers = [(*case, a.expand(found[:, k])) for k, case in enumerate(cases)]
        for curve, motion in motions.items():
            _, of_motion = a.evaluate(zero, zero, 0.0, moved=motion)
            answers.append((curve, 0.0, np.zeros((self.n, 6)), a.expand(a.solve(-a.gather(of_motion))) + motion))
        return answers

    # nonlinear

    def _nonlinear(self, end: float) -> None:
        """Newton's method to the end of the step, by halves where it does not converge."""
        how = self.problem.iteration
        start, smallest = self.time, (end - self.time) / 2**how.cuts
        now, length = start, end - start
        while now < end - 0.5 * smallest:
            until = min(now + length, end)
            try:
                self._part(now, until, end)
            except (NotConverged, Mechanism) as error:
                if length <= 1.5 * smallest:
                    raise
                length *= 0.5
                log.info("step %d: %s; cut to %g", self.step + 1, error, length)
                continue
            now = until
            length = min(2.0 * length, end - now) if now < end else length

    def _part(self, now: float, until: float, end: float) -> None:
        change = self._change(now, until, end)
        shape, internal, trace = equilibrium(
            self.assembly, self.shape, Target(change, lambda s: self.loads.at(until, s.u)), until - now,
            self.problem.iteration,
        )  # fmt: skip
        self.iterations += len(trace.residuals)
        log.debug("t = %g: residuals %s", until, " ".join(f"{r:.1e}" for r in trace.residuals))
        self._accept(shape, self.loads.at(until, shape.u), now, internal)

    def _change(self, now: float, until: float, end: float) -> Floats:
        """Prescribed change (n, 6) of displacement."""
        change = np.zeros((self.n, 6))
        for m in self.problem.motions:
            if m.incremental:  # the curve's value is this step's change, spread over its parts
                whole = end - float(self._ends[self.step])
                factor = self.loads.factor(m.curve, end) * (until - now) / whole
            else:
                factor = self.loads.factor(m.curve, until) - (self.loads.factor(m.curve, now) if now > 0.0 else 0.0)
            change[m.nodes, m.dofs] += factor * m.values
        return change

    def _accept(self, shape: Shape, external: Floats, now: float, internal: Floats | None = None) -> None:
        """Commit a shape; work of loads and supports by the trapezoidal rule."""
        if internal is None:
            internal, _ = self.assembly.evaluate(shape, self.shape, 0.0, stiff=False)
        moved = shape.u - self.shape.u
        reaction = np.where(self.assembly.free, 0.0, internal - external)
        all_forces, before = external + reaction, self.external_forces + self.reaction
        self.external_work += 0.5 * float(((all_forces + before) * moved).sum())
        self.assembly.commit()
        self.shape, self.reaction = shape, reaction
        self.internal_forces, self.external_forces = internal, external

    # what it shows

    def frame(self) -> Frame:
        """The state now, nodes and elements in the order of the deck."""
        return output.frame(self)

    def _energies(self) -> dict[str, float]:
        pairs = [g.energies() for g in self.assembly.groups]
        return {
            "kinetic": 0.0,
            "internal": sum(p[0] for p in pairs),
            "dissipated": sum(p[1] for p in pairs),
            "external_work": self.external_work,
        }

    def history(self) -> dict[str, float]:
        """One row of history.csv."""
        return output.history(self, self._energies())

    def energy_report(self) -> dict[str, float]:
        """Energies now; balance_error: internal energy (by stresses) against external work (by forces)."""
        return output.energy_report(self, self._energies())

    # to be continued

    def checkpoint(self) -> dict[str, Any]:
        """Everything that another process needs to go on."""
        data: dict[str, Any] = {"u": self.shape.u, "reaction": self.reaction, "internal_forces": self.internal_forces,
                                "external_forces": self.external_forces, "external_work": self.external_work,
                                "time": self.time, "step": self.step, "dt": self.dt}  # fmt: skip
        if self.shape.turn is not None:
            data["turn"] = self.shape.turn
        for k, group in enumerate(self.assembly.groups):
            data |= {f"group{k}_{name}": values for name, values in group.state().items()}
        return data

    def restore(self, data: dict[str, Any]) -> None:
        """Go on from a checkpoint of the same problem. ValueError when it is of another one."""
        if np.shape(data.get("u")) != (self.n, 6):
            raise ValueError("the checkpoint does not fit this run: the displacements have another shape")
        self.shape = Shape(np.array(data["u"]), np.array(data["turn"]) if "turn" in data else None)
        for name in ("reaction", "internal_forces", "external_forces"):
            setattr(self, name, np.array(data[name]))
        self.external_work, self.time, self.step = float(data["external_work"]), float(data["time"]), int(data["step"])
        self.dt = float(data["dt"])
        for k, group in enumerate(self.assembly.groups):
            prefix = f"group{k}_"
            group.restore({name.removeprefix(prefix): v for name, v in data.items() if name.startswith(prefix)})
