"""What the assembly needs of a group of elements, whatever they are; and chunks of them that stay in cache."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ..problem import Elements
from ..shape import Shape
from ..structure import Structure, product_of_elements, scatter, scatter_forces

Floats = NDArray[np.float64]
CHUNK = 256  # elements at a time


class Bad(ArithmeticError):
    """An element that has no volume or no stress. element: its number in the deck."""

    def __init__(self, element: int, cause: str) -> None:
        super().__init__(cause)
        self.element = element
        self.cause = cause


class Sink:
    """Where element matrices and forces go.

    forces: (n, 6); values: of the sparse matrix, or None without stiffness; moved: (n, 6) displacement whose force
    (matrix x moved) is added to `of_motion`, or None.
    """

    def __init__(self, forces: Floats, structure: Structure | None, values: Floats | None,
                 moved: Floats | None = None) -> None:  # fmt: skip
        self.forces = forces
        self.structure = structure
        self.values = values
        self.moved = moved
        self.of_motion = np.zeros_like(forces)

    @property
    def stiff(self) -> bool:
        """Whether matrices are wanted."""
        return self.values is not None

    def add(self, nodes: Any, dofs: Any, offsets: Any, forces: Floats, matrix: Floats | None) -> None:
        """Add element forces (e, c, n) and matrices (e, c, c, n, n). offsets: of these elements."""
        scatter_forces(forces, nodes, dofs, self.forces)
        if self.values is None or matrix is None:
            return
        s = self.structure
        assert s is not None
        scatter(matrix, nodes, offsets, dofs, s.equation, s.first, s.starts, s.symmetric, self.values)
        if self.moved is not None:
            product_of_elements(matrix, nodes, dofs, self.moved, self.of_motion)


class Group(Protocol):
    """Elements with their state."""

    elements: Elements
    dofs: NDArray[np.int64]

    @property
    def volume(self) -> Floats:
        """(e,) of the elements."""

    def bind(self, structure: Structure) -> None:
        """To a matrix structure."""

    def evaluate(self, shape: Shape, before: Shape, dt: float, sink: Sink) -> None:
        """Stresses, forces and stiffness at a shape; nothing is committed. before: the committed one. Raises Bad."""

    def commit(self) -> None:
        """Make the last evaluation the state to go on from."""

    def mass(self, sink: Sink, *, lumped: Floats | None = None) -> None:
        """Add the consistent mass to the sink, or the lumped one to (n, 6)."""

    def energies(self) -> tuple[float, float]:
        """Internal energy of the committed state, what flow has taken included, and that alone."""

    def weights(self) -> Floats:
        """(n, 3) mass of each node, for body forces."""

    def output(self) -> dict[str, Floats]:
        """Arrays (e, ...) by the names of the result folder."""

    def at_nodes(self) -> tuple[Floats, Floats]:
        """Stress (e, n, 6) at the elements' nodes, and (e,) volumes."""

    def forget(self) -> None:
        """What only speeds up the next iteration: a resumed run does not have it, so one that goes on drops it too."""

    def state(self) -> dict[str, Floats]:
        """What a checkpoint keeps, by name; `restore` takes it."""

    def restore(self, data: dict[str, Floats]) -> None:
        """Go on from a checkpoint."""
