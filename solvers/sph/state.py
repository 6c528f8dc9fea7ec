"""The state of a particle run: one block of numbers, named rows of it, and the order of the particles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..bundle import bundle
from ..gather import LANES, buffers, table
from ..jit import kernel
from ..neighbours import NeighbourList
from ..threads import run, share
from .nominal import HOURGLASS

Floats = NDArray[np.float64]


@bundle
class Arrays(NamedTuple):
    """Rows of the state that the loops see, each (m,) or (k, m): n particles, images, the dummy that pads rows.

    x y z, x_half.. (half a step back), x_list.. (where the list was built), x_start..: positions; u v w: velocities at
    the half step before; ax..: accelerations; stress (6 or 4: xx yy zz xy (yz zx)); gradient: of the velocity; s:
    (sigma - q I)/rho^2; density, volume m/rho, mass, h, energy, dissipated (per unit mass); viscosity: pressure q;
    nearest: squared distance; cx..: contact acceleration; contact_work: work of contact on a particle; state: the laws'
    history; h_start: h0 rho0^(1/d), h_list: h where the list was built; correction: inverse shape matrix; bx..:
    acceleration by artificial stress, artificial_work: its work on a particle; heat: power per mass of pair viscosity;
    density_rate, stress_rate: of diffusion; smoothed: velocities of XSPH; body_work: of a body force that changes;
    wave: speed now, where a law's changes; id, material, fixed (bits x y z): integers; first, count, rows: the
    neighbour list; c_first, c_count, c_rows: the list of other bodies; reduced: (threads, .) what each thread found;
    contact_heat: energy that friction and dashpots of the contact took on a particle; slip: elastic slip, how far it
    slid, the load of friction (d + 2, m); wall_slip: the same for each wall; colour: normal to other bodies, mobilised:
    traction by normal force, (d, m) each (see `slip`). Of total-Lagrangian bodies: deformation (d*d): F - I;
    hourglass: rows of `nominal`; nominal (d*d): V P M^-1 - kappa (F - I)/2. held (2 d, m): of
    stiff bodies with local steps, see `local`. hoop: r u, see `rings`. still, quiet, push: of sleeping, see `rest`;
    push (2 d, m): the speed that a sleeper was pushed to, and its acceleration when it fell asleep;
    bears (d, m): mean force of facets, see `leaning`.
    interface (0 | 1, m): see `across.interface_speed`. impulse, thrust (d, m): of what is driven, see `driving`;
    face_slip: friction on facets, see `facing`. relaxed (0 | 1, m): energy that dynamic relaxation took.
    packed, beside (m, 8): see `packed`; near: buffers for them, see `gather`.
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
    bx: Any
    by: Any
    bz: Any
    artificial_work: Any
    heat: Any
    h_start: Any
    h_list: Any
    correction: Any
    density_rate: Any
    stress_rate: Any
    smoothed: Any
    body_work: Any
    wave: Any
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
    contact_heat: Any
    slip: Any
    wall_slip: Any
    colour: Any
    mobilised: Any
    hoop: Any
    x_start: Any
    y_start: Any
    z_start: Any
    deformation: Any
    hourglass: Any
    nominal: Any
    held: Any
    impulse: Any
    thrust: Any
    face_slip: Any
    still: Any
    quiet: Any
    push: Any
    bears: Any
    interface: Any
    relaxed: Any
    packed: Any
    beside: Any
    near: Any


@bundle
class Numbers(NamedTuple):
    """The constants of a run.

    mixed: bodies of different density are neighbours. scale, force_scale: see `pairs`, the latter times the mass where
    all are equal; normal: a_d. viscous: (bodies, 4) linear and quadratic coefficient, density limits; wave:
    (bodies,) speeds, 0 of rigid ones. body: (3,) acceleration now, by the table
    body_times (k,), body_values (k, 3). h_option: as the deck's. relaxation: factor of the velocities in each step.
    pair_viscosity: (bodies, 2) alpha and beta; density_diffusion, stress_diffusion: (bodies,)
    factors; wall: (bodies,) the density of one that is a wall, else 0; kinematic_viscosity:
    (bodies,) of fluids, else 0; corrected: (bodies,) 1 where the gradient correction applies, else 0;
    inverse_w: 1/W at the particles' spacing;
    held_limits: whether held particles limit the step too;
    least_distance: in h, that counts for the step: an image comes as near to its particle as that to the plane.
    """

    dimension: int
    inverse_h2: float
    scale: float
    force_scale: float
    normal: float
    viscous: Any
    wave: Any
    body: Any
    body_times: Any
    body_values: Any
    h_option: int
    relaxation: float
    pair_viscosity: Any
    density_diffusion: Any
    stress_diffusion: Any
    wall: Any
    kinematic_viscosity: Any
    corrected: Any
    inverse_w: float
    held_limits: bool
    least_distance: float
    step_option: int
    step_factor: float
    original: bool
    mixed: bool


@kernel
def _permute(thread, threads, sync, numbers, whole, spare, rows, order):
    """numbers[k, i] = numbers[k, order[i]] for the first rows, by way of a spare row of each thread; all of whole."""
    r0, r1 = share(rows + len(whole), thread, threads)
    mine = spare[thread]
    for k in range(r0, min(r1, rows)):
        row = numbers[k]
        for i in range(len(order)):
            mine[i] = row[order[i]]
        for i in range(len(order)):
            row[i] = mine[i]
    counts = mine.view(np.int64)
    for k in range(max(r0, rows), r1):
        row = whole[k - rows]
        for i in range(len(order)):
            counts[i] = row[order[i]]
        for i in range(len(order)):
            row[i] = counts[i]


@dataclass(frozen=True, slots=True)
class Rows:
    """Which optional rows a run has.

    state: of the laws; the others say whether: contact, correction, artificial stress, pair viscosity (heat), density
    and stress diffusion, xsph, a changing h, a changing body force, a changing wave speed, heat of contact, slip
    between bodies, normals; wall_slip: walls with friction; total-Lagrangian bodies; local steps; hoop stress of
    a body of revolution; sleep of what is at rest; bears: on facets; birth of particles to come; absent: whether
    particles may be, which takes no row; interface: bodies much heavier and stiffer than their neighbours; driven
    particles; face_slip: rows of friction on facets; relaxed: dynamic relaxation.
    """

    state: int = 0
    contact: bool = False
    correction: bool = False
    artificial: bool = False
    heat: bool = False
    density_rate: bool = False
    stress_rate: bool = False
    xsph: bool = False
    changing_h: bool = False
    body_work: bool = False
    wave: bool = False
    contact_heat: bool = False
    slip: bool = False
    normals: bool = False
    wall_slip: int = 0
    lagrangian: bool = False
    local: bool = False
    hoop: bool = False
    driven: bool = False
    face_slip: int = 0
    sleep: bool = False
    bears: bool = False
    birth: bool = False
    absent: bool = False
    interface: bool = False
    relaxed: bool = False


_WHOLE = ("id", "material", "fixed")  # what is counted in whole numbers, beside the rows


class State:
    """Storage of the rows above in one array of (rows, n + images + 1), so that sorting moves everything at once.

    The dummy is the last entry, behind the images. packs: whether loops read the two tables of `packed`.
    """

    def __init__(self, n: int, dimension: int, has: Rows, *, packs: tuple[bool, bool]) -> None:
        solid = dimension == 3
        d = 3 if solid else 2  # a line runs as a plane with y = 0
        self.n = n
        self.d = d
        six = 6 if solid else 4
        sizes = {
            "x": d, "u": d, "a": d, "x_half": d, "x_list": d, "x_start": d, "stress": six,
            "density": 1, "volume": 1, "mass": 1, "h": 1, "energy": 1, "dissipated": 1, "viscosity": 1,
            "contact_work": int(has.contact), "artificial_work": int(has.artificial or has.lagrangian),
            "heat": int(has.heat),
            "h_start": int(has.changing_h), "h_list": int(has.changing_h), "body_work": int(has.body_work),
            "wave": int(has.wave), "b": d if has.artificial else 0, "contact_heat": int(has.contact_heat),
            "slip": (d + 2) * has.slip, "wall_slip": (d + 2) * has.wall_slip,
            "deformation": d * d if has.lagrangian else 0, "hourglass": HOURGLASS if has.lagrangian else 0,
            "held": 2 * d * has.local, "impulse": d * has.driven, "face_slip": has.face_slip,
            "still": int(has.sleep), "quiet": int(has.sleep), "push": 2 * d * has.sleep, "bears": d * has.bears,
            "birth": int(has.birth),
            "interface": int(has.interface), "relaxed": int(has.relaxed),
            "state": has.state,
            "gradient": d * d, "s": (d * d if has.correction or has.hoop else 6 if solid else 3), "nearest": 1,
            "c": d if has.contact else 0, "correction": (7 if solid else 4) if has.correction else 0,
            "density_rate": int(has.density_rate), "stress_rate": six if has.stress_rate else 0,
            "smoothed": d if has.xsph else 0, "colour": d * has.normals, "mobilised": d * has.slip,
            "nominal": d * d if has.lagrangian else 0, "hoop": int(has.hoop), "thrust": d * has.driven,
        }  # fmt: skip
        self.slices: dict[str, slice] = {}
        at = 0
        for name, rows in sizes.items():
            self.slices[name] = slice(at, at + rows)
            at += rows
        # the rows above are made anew in each step; those before them follow a sorted particle and go into a checkpoint
        # (of sleepers nothing is made anew)
        self.lasting = at if has.sleep else self.slices["state"].stop
        self._rows = at
        self._packs = packs
        self._seen: tuple[tuple[Any, ...], Arrays] | None = None
        self.id: NDArray[np.int64]
        self.material: NDArray[np.int64]
        self.fixed: NDArray[np.int64]
        self._allocate(0)

    def _allocate(self, room: int) -> None:
        self.dummy = self.n + room
        width = (self.dummy + 1 + 7) // 8 * 8 + 8
        if width % 512 == 0:
            width += 8  # rows a multiple of 4 KiB apart would share the same cache sets
        self.numbers: Floats = table(self._rows * width // LANES).reshape(self._rows, width)
        self.packed, self.beside = (table(self.dummy + 1 if packs else 0) for packs in self._packs)
        self._whole = np.zeros((3, self.dummy + 1), np.int64)
        self.id, self.material, self.fixed = self._whole

    def make_room(self, room: int) -> None:
        """Have room for so many images at least."""
        if self.n + room <= self.dummy:
            return
        old = self.numbers, self._whole
        self._allocate(room + room // 4)
        n = self.n
        self.numbers[:, :n] = old[0][:, :n]
        self._whole[:, :n] = old[1][:, :n]
        self.place_dummy(self.far)

    def rows(self, name: str) -> Floats:
        """(k, dummy + 1) rows of one name; a view."""
        return self.numbers[self.slices[name], : self.dummy + 1]

    def row(self, name: str, k: int = 0) -> Floats | None:
        """(dummy + 1,) one row of a name, None where it has none; a view."""
        rows = self.rows(name)
        return rows[k] if k < len(rows) else None

    def sort(self, order: NDArray[np.int64], threads: int) -> None:
        """Put the particles into a new order; order: old places, of all or of the first."""
        run(_permute, threads, self.numbers, self._whole, np.empty((threads, len(order))), self.lasting, order)

    def kept(self) -> dict[str, Any]:
        """All rows and numbers of the particles, for a checkpoint."""
        n = self.n
        whole = {name: getattr(self, name)[:n].copy() for name in _WHOLE}
        return {name: np.array(self.rows(name)[:, :n]) for name in self.slices} | whole

    def restore(self, data: dict[str, Any]) -> None:
        """Take them back. ValueError when they are of another run."""
        n = self.n
        wanted = [name for name in self.slices if name in data or len(self.rows(name))]
        for name in wanted:
            if name not in data or np.shape(data[name]) != self.rows(name)[:, :n].shape:
                raise ValueError(f"the checkpoint does not fit this run: {name} is missing or has another shape")
        for name in wanted:
            self.rows(name)[:, :n] = data[name]
        for name in _WHOLE:
            getattr(self, name)[:n] = data[name]

    def place_dummy(self, far: float) -> None:
        """Put the dummy out of everybody's reach; its mass and volume are zero."""
        self.far = far
        for name in ("x", "x_half"):
            self.rows(name)[:, self.dummy] = far
        self.rows("h")[:, self.dummy] = self.rows("h")[:, : self.n].max()
        self.rows("density")[:, self.dummy] = 1.0

    def forget(self) -> None:
        """Let go of what `arrays` gave, before lists or rows are made anew: the old ones would stand beside them."""
        self._seen = None

    def arrays(self, neighbours: NeighbourList, others: NeighbourList, reduced: Floats) -> Arrays:
        """What the loops see; views. The same object as long as they are the same arrays."""
        parts = (
            self.numbers, neighbours.first, neighbours.count, neighbours.rows, others.first, others.count, others.rows,
            reduced,
        )  # fmt: skip
        if self._seen is not None and all(a is b for a, b in zip(parts, self._seen[0], strict=True)):
            return self._seen[1]
        axes = {
            f"{axis}{suffix}": self.row(f"x{suffix}", k)
            for suffix in ("", "_half", "_list", "_start")
            for k, axis in enumerate("xyz")
        }
        axes |= {name: self.row("u", k) for k, name in enumerate("uvw")}
        axes |= {f"{letter}{axis}": self.row(letter, k) for letter in "acb" for k, axis in enumerate("xyz")}
        single = {name: self.row(name) for name in ONE_ROW}
        several = {name: self.rows(name) for name in ALL_ROWS}
        seen = Arrays(
            **axes,
            **single,
            **several,
            id=self.id,
            material=self.material,
            fixed=self.fixed,
            first=neighbours.first,
            count=neighbours.count,
            rows=neighbours.rows,
            c_first=others.first,
            c_count=others.count,
            c_rows=others.rows,
            reduced=reduced,
            packed=self.packed,
            beside=self.beside,
            near=buffers(len(reduced)),
        )
        self._seen = parts, seen
        return seen


# what the loops see under its own name: one row of it, or all
ONE_ROW = (
    "contact_work", "artificial_work", "heat", "h_start", "h_list", "density_rate", "body_work", "wave", "density",
    "volume", "mass", "h", "energy", "dissipated", "viscosity", "nearest", "contact_heat", "hoop", "still", "quiet",
)  # fmt: skip
ALL_ROWS = (
    "correction", "stress_rate", "smoothed", "stress", "gradient", "s", "state", "slip", "wall_slip", "colour",
    "mobilised", "deformation", "hourglass", "nominal", "held", "impulse", "thrust", "face_slip", "push",
    "bears", "interface", "relaxed",
)  # fmt: skip
