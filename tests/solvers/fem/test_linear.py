"""Sparse systems: factors of single precision, made good by conjugate gradients, where all digits are asked for."""

from __future__ import annotations

import logging

import numpy as np
import pytest
import scipy.sparse as sp

from zrno.solvers.fem import linear
from zrno.solvers.fem.libraries import Pardiso, Singular
from zrno.solvers.threads import available

pytestmark = pytest.mark.skipif("pardiso" not in linear.installed(), reason="PARDISO is not installed")


def _springs(size: int, stiff: float = 1.0, support: float = 1.0) -> sp.csr_matrix:
    """A cube of springs with feet on the ground, one half `stiff` times as stiff: the upper triangle."""
    line = sp.diags([-np.ones(size - 1), 2.0 * np.ones(size), -np.ones(size - 1)], [-1, 0, 1]).tolil()
    line[0, 0] = line[size - 1, size - 1] = 1.0
    one = sp.eye(size)
    cube = sp.kron(sp.kron(line, one), one) + sp.kron(sp.kron(one, line), one) + sp.kron(sp.kron(one, one), line)
    weight = sp.diags(np.where(np.arange(size**3) < size**3 // 2, 1.0, np.sqrt(stiff)))
    upper = sp.triu(weight @ (cube + support * sp.eye(size**3)) @ weight).tocsr()
    upper.sort_indices()
    return upper


def _system(upper: sp.csr_matrix, *, single: bool = True, answers: int = 1) -> linear.System:
    system = linear.System(upper.indptr, upper.indices, method="pardiso", single=single)
    system.values[:] = upper.data
    system.factor(answers=answers)
    return system


@pytest.fixture(autouse=True)
def _all_are_large(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(linear, "LARGE", 0)


def test_the_product_by_a_triangle_is_that_of_the_whole() -> None:
    """One vector, and several at once."""
    system = _system(_springs(5))
    right = np.random.default_rng(1).standard_normal((125, 3))
    assert np.allclose(system.product(right), system.full() @ right, rtol=0.0, atol=1e-13)
    assert np.allclose(system.product(right[:, 1]), system.full() @ right[:, 1], rtol=0.0, atol=1e-13)


@pytest.mark.parametrize("scale", [1.0, 1e-60])
def test_single_factors_answer_with_all_digits(scale: float) -> None:
    """Right sides beyond single precision's range too; a column of zeros among them."""
    upper = _springs(9, stiff=100.0, support=1e-3)
    right = scale * np.random.default_rng(2).standard_normal((729, 2))
    right[:, 1] = 0.0
    system = _system(upper)
    found = system.solve(right)
    exact = _system(upper, single=False).solve(right)
    assert type(system._factors).__name__ == "Mixed"
    assert np.abs(found - exact).max() <= 1e-11 * np.abs(exact).max()


def test_many_right_sides_get_factors_of_all_digits() -> None:
    """What is asked again and again is not answered by iterations."""
    system = _system(_springs(6))
    right = np.ones(216)
    for _ in range(4):
        system.solve(right)
    assert system.factorisations == 1
    system.solve(right)
    system.solve(right)
    assert system.factorisations == 2
    known = _system(_springs(6), answers=5)
    known.solve(np.ones((216, 5)))
    assert known.factorisations == 1


@pytest.mark.parametrize("size", [40, 400])
def test_what_single_precision_does_not_carry_is_solved_in_double(size: int, caplog: pytest.LogCaptureFixture) -> None:
    """A beam of differences, whose condition grows by the fourth power of its points; the log says so."""
    bend = sp.diags([np.ones(size - 1), -2.0 * np.ones(size), np.ones(size - 1)], [-1, 0, 1])
    upper = sp.triu(bend @ bend).tocsr()
    upper.sort_indices()
    with caplog.at_level(logging.INFO, logger="zrno"):
        system = _system(upper)
        answer = system.solve(np.ones(size))
    exact = _system(upper, single=False).solve(np.ones(size))
    assert np.abs(answer - exact).max() <= 1e-16 * size**4 * np.abs(exact).max()
    assert ("single precision factors do not do" in caplog.text) == (size > 40)


def test_a_singular_matrix_is_told() -> None:
    """A cube without feet, pushed."""
    with pytest.raises(Singular):
        _system(_springs(6, support=0.0)).solve(np.ones(216))


def test_threads_are_all_of_a_large_system_and_one_of_a_small_one() -> None:
    """What is asked for is taken."""
    assert linear.threads_for(5_000, None) == 1
    assert linear.threads_for(50_000, None) == available()
    assert linear.threads_for(5_000, 3) == linear.threads_for(50_000, 3) == 3


def _mesh(seed: int, parts: int) -> sp.csr_matrix:
    """Random elements of four nodes with `parts` unknowns each, a tenth of them held: the upper triangle."""
    rng = np.random.default_rng(seed)
    nodes = 400
    elements = (rng.integers(0, nodes, (700, 1)) + rng.integers(0, 12, (700, 4))) % nodes
    near = sp.csr_matrix((np.ones(2800), (np.repeat(np.arange(700), 4), elements.ravel())), shape=(700, nodes))
    pattern = sp.kron(near.T @ near + sp.eye(nodes), np.ones((parts, parts))).tocsr()
    free = np.flatnonzero(rng.random(nodes * parts) > 0.1)
    pattern = sp.triu(pattern[free][:, free], 1).tocsr()
    pattern.data = -rng.random(pattern.nnz)
    full = pattern + pattern.T
    upper = sp.triu(full + sp.diags(1.0 - np.asarray(full.sum(axis=1)).ravel())).tocsr()
    upper.sort_indices()
    return upper


@pytest.mark.parametrize("single", [False, True])
@pytest.mark.parametrize("parts", [1, 2, 3, 6])
def test_factors_by_blocks_are_those_by_equations(parts: int, single: bool) -> None:
    """Meshes, and a band, in which no two equations have the same columns."""
    bend = sp.diags([np.ones(39), -2.0 * np.ones(40), np.ones(39)], [-1, 0, 1])
    band = sp.triu(bend @ bend + sp.eye(40)).tocsr()
    for upper in (band, *(_mesh(seed, parts) for seed in range(5))):
        system = _system(upper, single=False)
        factors = Pardiso(system, single=single, blocks=True)
        factors.factor(system.values)
        right = np.ones(system.n)
        left = right - system.product(factors.solve(right))
        assert np.abs(left).max() < (1e-4 if single else 1e-12)


def test_the_equation_without_a_pivot_is_told_by_blocks_too() -> None:
    """Block factors alone do not know it."""
    upper = _mesh(0, 3)
    system = _system(upper, single=False)
    system.values[system.starts[777]] = -1.0
    with pytest.raises(Singular) as told:
        Pardiso(system, blocks=True).factor(system.values)
    assert told.value.equation == 777
