"""Kinematics of a straight two-node beam that goes along with its own turning frame (Battini & Pacoste 2002).

The frame's first axis joins the ends, its third is normal to that and to the mean of the second axes of both ends. Seen
from the frame the beam stretches and its ends turn by small angles, which the stiffness of small displacements answers.
Arrays run over e beams; vectors of 12: displacement and rotation of both ends.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
STEP = 1e-6  # of the length and of a radian, for differences of directions


def crossed(v: Floats) -> Floats:
    """(..., 3, 3): what times w is v x w."""
    out = np.zeros((*v.shape, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        out[..., k, j], out[..., j, k] = v[..., i], -v[..., i]
    return out


def turned(turn: Floats, vectors: Floats) -> Floats:
    """exp of rotation vectors (..., 3) times rotations (..., 3, 3)."""
    angle = np.linalg.norm(vectors, axis=-1)[..., None, None]
    w = crossed(vectors)
    half = 0.5 * angle
    out: Floats = turn + (np.sinc(angle / np.pi) * w + 0.5 * np.sinc(half / np.pi) ** 2 * (w @ w)) @ turn
    return out


def rotation_vector(turn: Floats) -> Floats:
    """(..., 3) of rotations (..., 3, 3) below half a turn (Spurrier's quaternion where its first part is large)."""
    scalar = 0.5 * np.sqrt(np.maximum(1.0 + np.trace(turn, axis1=-2, axis2=-1), 1e-30))
    skew = np.stack([turn[..., 2, 1] - turn[..., 1, 2], turn[..., 0, 2] - turn[..., 2, 0],
                     turn[..., 1, 0] - turn[..., 0, 1]], axis=-1)  # fmt: skip
    vector = 0.25 * skew / scalar[..., None]
    sine = np.linalg.norm(vector, axis=-1)
    angle = 2.0 * np.arctan2(sine, scalar)
    share = np.where(sine > 1e-12, angle / np.maximum(sine, 1e-300), 2.0)
    out: Floats = share[..., None] * vector
    return out


def frames(x: Floats, turn: Floats, axes: Floats) -> tuple[Floats, Floats, Floats]:
    """The frames (e, 3, 3), an axis a row, the lengths (e,), and the ends' second axes (e, 2, 3) in them.

    x: (e, 2, 3) places of the ends; turn: (e, 2, 3, 3) their rotations; axes: (e, 3, 3) at the start, an axis a row.
    """
    along = x[:, 1] - x[:, 0]
    length = np.linalg.norm(along, axis=1)
    first = along / length[:, None]
    seconds = np.einsum("enij,ej->eni", turn, axes[:, 1])
    third = np.cross(first, seconds.mean(axis=1))
    third /= np.linalg.norm(third, axis=1, keepdims=True)
    frame = np.stack([first, np.cross(third, first), third], axis=1)
    return frame, length, np.einsum("eij,enj->eni", frame, seconds)


def deformation(x: Floats, turn: Floats, axes: Floats, start: Floats) -> tuple[Floats, Floats, Floats]:
    """In the frames: displacements (e, 12) without the rigid part, their rows (e, 12, 12) by displacements and spins in
    space, and the frames. start: (e,) lengths at the start; else see `frames`."""
    frame, length, seconds = frames(x, turn, axes)
    e = len(x)
    rigid = np.zeros((e, 3, 12))  # the frame's spin by displacements and spins in the frame
    mean = seconds.mean(axis=1)
    lean = mean[:, 0] / mean[:, 1]
    for n, sign in ((0, 1.0), (1, -1.0)):
        at = 6 * n
        rigid[:, 0, at + 2] = sign * lean / length
        rigid[:, 1, at + 2] = sign / length
        rigid[:, 2, at + 1] = -sign / length
        rigid[:, 0, at + 3] = 0.5 * seconds[:, n, 1] / mean[:, 1]
        rigid[:, 0, at + 4] = -0.5 * seconds[:, n, 0] / mean[:, 1]
    local, rows = np.zeros((e, 12)), np.zeros((e, 12, 12))
    local[:, 6] = length - start
    rows[:, 6, 0], rows[:, 6, 6] = -1.0, 1.0
    own = np.einsum("eij,enjk,elk->enil", frame, turn, axes)
    for n in (0, 1):
        turns = slice(6 * n + 3, 6 * n + 6)
        vector = rotation_vector(own[:, n])
        local[:, turns] = vector
        spin = -rigid
        spin[:, :, turns] += np.eye(3)
        rows[:, turns] = _of_spin(vector) @ spin
    big = np.zeros((e, 12, 12))
    for k in range(4):
        big[:, 3 * k : 3 * k + 3, 3 * k : 3 * k + 3] = frame
    return local, rows @ big, frame


def _of_spin(vector: Floats) -> Floats:
    """(e, 3, 3): the change of rotation vectors (e, 3) by a spin in space."""
    angle = np.linalg.norm(vector, axis=1)
    small = angle < 1e-3
    safe = np.where(small, 1.0, angle)
    share = np.where(small, 1.0 / 12.0 + angle**2 / 720.0, (1.0 - 0.5 * safe / np.tan(0.5 * safe)) / safe**2)
    w = crossed(vector)
    out: Floats = np.eye(3) - 0.5 * w + share[:, None, None] * (w @ w)
    return out


def geometric(x: Floats, turn: Floats, axes: Floats, start: Floats, forces: Floats) -> Floats:
    """(e, 12, 12): how the forces in space grow where those in the frame (e, 12) stay; by central differences.

    The symmetric part: second derivatives of the energy by rotation vectors, see `Assembly.evaluate`.
    """
    out = np.empty((len(x), 12, 12))
    for k in range(12):
        node, c = divmod(k, 6)
        sides = []
        for sign in (1.0, -1.0):
            places, rotations = x.copy(), turn.copy()
            if c < 3:
                step = STEP * start
                places[:, node, c] += sign * step
            else:
                step = np.full(len(x), STEP)
                rotations[:, node] = turned(turn[:, node], sign * STEP * np.eye(3)[c - 3])
            rows = deformation(places, rotations, axes, start)[1]
            sides.append(np.einsum("eqi,eq->ei", rows, forces))
        out[:, :, k] = (sides[0] - sides[1]) / (2.0 * step[:, None])
    return 0.5 * (out + out.transpose(0, 2, 1))
