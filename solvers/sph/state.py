"""The state of a particle run: one block of numbers, named rows of it, and the order of the particles."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..jit import kernel
from ..threads import run, share

Floats = NDArray[np.float64]


class Arrays(NamedTuple):
    """Rows of the state that the loops see, each (n + 1,) or (k, n + 1); entry n is the dummy that pads neighbour rows.

    x y z, x_half.. (half a step back), x_list.. (where the list was built), x_start..: positions; u v w: velocities at
    the half step before; ax..: accelerations; stress (6 or 4: xx yy zz xy (yz zx)); gradient: of the velocity; s:
    (sigma - q I)/rho^2; density, volume m/rho, mass, h, energy, dissipated (per unit mass); viscosity: pressure q;
    nearest: squared distance; cx..: contact acceleration; contact_work: work of contact on a particle; state: the laws'
    history; id, material, fixed (bits x y z): integers; first, count, rows: the neighbour list; c_first, c_count,
    c_rows: the list of other bodies; reduced: (threads, .) what each thread found.
    """

    x: Any
    y: Any
    z: Any
    u: Any
    v: Any
    w: Any
    x_half: Any
    y_half: Any
    z_half: Any
    x_list: Any
    y_list: Any
    z_list: Any
    ax: Any
    ay: Any
    az: Any
    cx: Any
    cy: Any
    cz: Any
    contact_work: Any
    stress: Any
    gradient: Any
    s: Any
    density: Any
    volume: Any
    mass: Any
    h: Any
    energy: Any
    dissipated: Any
    viscosity: Any
    nearest: Any
    state: Any
    id: Any
    material: Any
    fixed: Any
    first: Any
    count: Any
    rows: Any
    c_first: Any
    c_count: Any
    c_rows: Any
    reduced: Any


class Numbers(NamedTuple):
    """The constants of a run.

    mixed: bodies of different density are neighbours. scale, force_scale: see `pairs`, the latter times the mass where
    all are equal; normal: a_d. viscous: (bodies, 4) linear coefficient times c, quadratic, density limits; wave:
    (bodies,) speeds; strength, exponent: (bodies,) of the contact.
    """

    dimension: int
    inverse_h2: float
    scale: float
    force_scale: float
    normal: float
    viscous: Any
    wave: Any
    body_x: float
    body_y: float
    body_z: float
    step_option: int
    step_factor: float
    original: bool
    mixed: bool
    strength: Any
    exponent: Any


@kernel
def _permute(thread, threads, sync, numbers, spare, rows, order):
    """numbers[k, i] = numbers[k, order[i]] for the first rows, by way of the spare array."""
    r0, r1 = share(rows, thread, threads)
    for k in range(r0, r1):
        for i in range(len(order)):
            spare[k, i] = numbers[k, order[i]]
        for i in range(len(order)):
            numbers[k, i] = spare[k, i]


class State:
    """Storage of the rows above in one array of (rows, n + 1 and some), so that sorting moves everything at once."""

    def __init__(self, n: int, dimension: int, state_rows: int, contact: bool) -> None:
        solid = dimension == 3
        d = 3 if solid else 2  # a line runs as a plane with y = 0
        self.n = n
        self.d = d
        sizes = {
            "x": d, "u": d, "a": d, "x_half": d, "x_list": d, "x_start": d, "stress": 6 if solid else 4,
            "density": 1, "volume": 1, "mass": 1, "h": 1, "energy": 1, "dissipated": 1, "viscosity": 1,
            "contact_work": int(contact), "state": state_rows,
            "gradient": d * d, "s": 6 if solid else 3, "nearest": 1, "c": d if contact else 0,
        }  # fmt: skip
        self.slices: dict[str, slice] = {}
        at = 0
        for name, rows in sizes.items():
            self.slices[name] = slice(at, at + rows)
            at += rows
        # the rows above are made anew in each step; those before them follow a sorted particle and go into a checkpoint
        self.lasting = self.slices["state"].stop
        width = (n + 1 + 7) // 8 * 8 + 8
        if width % 512 == 0:
            width += 8  # rows a multiple of 4 KiB apart would share the same cache sets
        self.numbers: Floats = np.zeros((at, width))
        self._spare: Floats = np.zeros((self.lasting, width))
        self.id: NDArray[np.int64] = np.zeros(n + 1, np.int64)
        self.material: NDArray[np.int64] = np.zeros(n + 1, np.int64)
        self.fixed: NDArray[np.int64] = np.zeros(n + 1, np.int64)

    def rows(self, name: str) -> Floats:
        """(k, n + 1) rows of one name; a view."""
        return self.numbers[self.slices[name], : self.n + 1]

    def row(self, name: str, k: int = 0) -> Floats | None:
        """(n + 1,) one row of a name, None where it has none; a view."""
        rows = self.rows(name)
        return rows[k] if k < len(rows) else None

    def sort(self, order: NDArray[np.int64], threads: int) -> None:
        """Put the particles into a new order; order: (n,) old places."""
        n = self.n
        run(_permute, threads, self.numbers, self._spare, self.lasting, order)
        for whole in (self.id, self.material, self.fixed):
            whole[:n] = whole[:n][order]

    def place_dummy(self, far: float) -> None:
        """Put the dummy out of everybody's reach; its mass and volume are zero."""
        n = self.n
        for name in ("x", "x_half"):
            self.rows(name)[:, n] = far
        self.rows("h")[:, n] = self.rows("h")[:, :n].max()
        self.rows("density")[:, n] = 1.0
