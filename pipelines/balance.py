"""The energy balance, watched: an unstable run that does not explode ends like a sound one, but for this."""

from __future__ import annotations

from zrno.pipelines.observing import Solver

LIMIT = 0.05  # of the largest energy so far; the samples end below 0.01


class Balance:
    """Observer: since when the energy balance error has been above `LIMIT`.

    interval: simulated time between looks; for the message: step_factor of the run, None where it has none, and whether
    it does as the original programs do.
    """

    exact = False

    def __init__(self, *, interval: float | None, step_factor: float | None, original: bool = False) -> None:
        self.interval = interval
        self._original = original
        self._step_factor = step_factor
        self._since: float | None = None
        self._resumed = False

    def start(self, solver: Solver) -> None:
        """A resumed run may begin above the limit."""
        self.observe(solver)
        self._resumed = self._since is not None

    def observe(self, solver: Solver) -> None:
        """Note the time where the error passes the limit, and forget it where the error comes back."""
        if not _error(solver) > LIMIT:
            self._since, self._resumed = None, False
        elif self._since is None:
            self._since = solver.time

    def finish(self, solver: Solver) -> None:
        """The last look."""
        self.observe(solver)

    def warning(self, solver: Solver) -> str | None:
        """What to say of the balance now; None where it holds."""
        self.observe(solver)
        if self._since is None:
            return None
        error = _error(solver)
        out = f"{error:.0%} of" if error < 10 else f"{error:.3g} times"
        passed = f"was above {LIMIT:.0%} when the run was resumed at" if self._resumed else f"passed {LIMIT:.0%} at"
        cause = self._cause(solver)
        return (
            f"the energy balance is out by {out} the largest of kinetic energy, internal energy and external work in "
            f"the run; it {passed} t = {self._since:.4g}: the likely cause is {cause}"
        )

    def _cause(self, solver: Solver) -> str:
        row = solver.history()
        if self._original and "interface_energy" in row:
            return "what the original programs do between structure and particles (compat=original)"
        made = abs(float(row.get("interface_energy", 0.0)))
        report = solver.energy_report()
        if made and made > 0.5 * abs(report["final"] - report["initial"] - report["external_work"]):
            return (
                "the lag between structure and particles, try coupling.tolerance (1e-3), more steps of the structure, "
                "or a smaller coupling.relaxation"
            )
        if self._step_factor is None:
            return "steps that are too long for the path of loading or of plastic flow, try more of them"
        return f"a time step above the stable limit, try a step_factor below {self._step_factor:g}"


def _error(solver: Solver) -> float:
    return float(solver.energy_report()["balance_error"])
