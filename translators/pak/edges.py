"""Tractions on edges of plane elements as forces on their nodes: a PAK deck has pressure and shear there alone.

The forces are those of the traction by the shape functions along the edge, so that a structure gets the same ones. In
axisymmetry a force is per unit of its node's circumference, as PAK reads it; a node on the axis cannot have one.
"""

from __future__ import annotations

import numpy as np

from zrno.translators.model import FaceLoad, Floats, Ints, NodalLoad

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(3)
_SHAPES = {  # values and derivatives at the points: two ends, and a middle
    2: (np.column_stack([0.5 * (1 - _POINTS), 0.5 * (1 + _POINTS)]), np.tile([-0.5, 0.5], (3, 1))),
    3: (
        np.column_stack([0.5 * _POINTS * (_POINTS - 1), 0.5 * _POINTS * (_POINTS + 1), 1 - _POINTS**2]),
        np.column_stack([_POINTS - 0.5, _POINTS + 0.5, -2 * _POINTS]),
    ),
}


def nodal_forces(xyz: Floats, load: FaceLoad, thickness: float, *, axisymmetric: bool) -> tuple[NodalLoad, int]:
    """The forces of a traction on edges, and how many nodes on the axis lose theirs."""
    total = np.zeros(len(xyz))
    count = (load.faces[:, :3] >= 0).sum(axis=1)
    for size in np.unique(count).tolist():
        rows = count == size
        nodes: Ints = load.faces[rows][:, :size]
        shape, slope = _SHAPES[size]
        places = xyz[nodes]
        values = load.values.reshape(len(load.faces), -1)[rows]
        ends = np.column_stack([values[:, 0], values[:, min(1, values.shape[1] - 1)]])
        strength = ends @ _SHAPES[2][0].T * _WEIGHTS * np.linalg.norm(np.einsum("gk,fki->fgi", slope, places), axis=2)
        strength *= np.einsum("gk,fk->fg", shape, places[:, :, 0]) if axisymmetric else thickness
        np.add.at(total, nodes, strength @ shape)
    used = np.flatnonzero(total)
    lost = 0
    if axisymmetric:
        off = xyz[used, 0] > 1e-12 * np.abs(xyz).max()
        lost, used = int((~off).sum()), used[off]
        total[used] /= xyz[used, 0]
    dofs = np.full(len(used), load.direction)
    return NodalLoad("force", used, dofs, total[used], load.curve, id=load.id, name=load.name), lost
