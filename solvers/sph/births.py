"""Particles that are born during a run: grain on its way to an opening.

Until its time comes a particle goes straight on with the velocity of its start, without weight; it feels nothing and
nothing feels it. It then is where that motion has brought it, and from then on a particle like any other. In the arrays
those that are to come stand behind the live ones, among those that have left (`ghosts.leave`), at the place of their
start; the row `birth` has their time, zero of all others.
"""

from __future__ import annotations

import numpy as np

from .state import State


def due(s: State, live: int) -> float:
    """When the next particle is born; infinite where none is to come."""
    times = s.rows("birth")[:, live : s.n]
    return float(np.min(times, where=times > 0.0, initial=np.inf))


def set_apart(s: State, threads: int) -> int:
    """Put those that are to come behind the others; returns how many are live."""
    to_come = s.rows("birth")[0, : s.n] > 0.0
    s.sort(np.concatenate((np.flatnonzero(~to_come), np.flatnonzero(to_come))), threads)
    return s.n - int(np.count_nonzero(to_come))


def enter(s: State, live: int, time: float, last: float, threads: int) -> int:
    """Bring in those whose time has come; returns how many are live then. last: the step that led to this time."""
    birth = s.rows("birth")[0, live : s.n]
    born = (birth > 0.0) & (birth <= time)
    if not np.any(born):
        return live
    order = np.concatenate((np.arange(live), live + np.flatnonzero(born), live + np.flatnonzero(~born)))
    s.sort(order, threads)
    new = slice(live, live + int(np.count_nonzero(born)))
    velocity = s.rows("u")[:, new]
    for name, back in (("x", 0.0), ("x_half", 0.5 * last)):
        s.rows(name)[:, new] = s.rows("x_start")[:, new] + velocity * (time - back)
    s.rows("x_start")[:, new] = s.rows("x")[:, new]
    s.rows("birth")[:, new] = 0.0
    return new.stop
