"""Speed of the material laws: nanoseconds an update, elastic and flowing, without and with the consistent tangent, and
the seconds that compiling takes.

    python tests/benchmarks/bench_materials.py [points [name]]

name: only the laws whose name has it in it.

One thread, points one after another as in the solvers, each with its own stress and state. "flowing": sheared and
pressed back and forth by 0.2 % a step, so that nearly every update returns to a surface. "compile" is 0 where the disk
cache has the loop; `XDG_CACHE_HOME=$(mktemp -d)` empties it. Run it on a quiet machine.
"""

from __future__ import annotations

import sys
import time
from typing import Any

import numpy as np

from zrno.solvers import materials as laws
from zrno.solvers.jit import compile_seconds, kernel
from zrno.solvers.materials.law import stress_update
from zrno.solvers.materials.tangent import stress_and_tangent

STEPS = 40


@kernel
def update_all(law, strain, stress, state, rho, e, dt):
    """One update of every point; strain, stress: (6, n)."""
    for i in range(stress.shape[1]):
        xx, yy, zz, xy, yz, zx, _ = stress_update(
            law, strain[0, i], strain[1, i], strain[2, i], strain[3, i], strain[4, i], strain[5, i],
            stress[0, i], stress[1, i], stress[2, i], stress[3, i], stress[4, i], stress[5, i],
            rho[i], e[i], dt, state, i,
        )  # fmt: skip
        stress[0, i] = xx
        stress[1, i] = yy
        stress[2, i] = zz
        stress[3, i] = xy
        stress[4, i] = yz
        stress[5, i] = zx


@kernel
def tangents_of_all(law, strain, stress, state, rho, e, dt):
    """As `update_all`, with the tangent."""
    scratch, modulus = np.empty((state.shape[0], 2)), np.empty((1, 6, 6))
    for i in range(stress.shape[1]):
        xx, yy, zz, xy, yz, zx, _ = stress_and_tangent(
            law, strain[0, i], strain[1, i], strain[2, i], strain[3, i], strain[4, i], strain[5, i],
            stress[0, i], stress[1, i], stress[2, i], stress[3, i], stress[4, i], stress[5, i],
            rho[i], e[i], dt, state, i, scratch, modulus, 0,
        )  # fmt: skip
        stress[0, i] = xx
        stress[1, i] = yy
        stress[2, i] = zz
        stress[3, i] = xy
        stress[4, i] = yz
        stress[5, i] = zx


def nanoseconds(law: laws.Law, n: int, size: float, update: Any = update_all) -> float:
    """Median CPU time of an update; size: of the strain increments."""
    rng = np.random.default_rng(1)
    strain = rng.normal(size=(6, n)) * size
    strain[:3] -= 0.7 * strain[:3].mean(axis=0)
    stress, state = np.zeros((6, n)), np.zeros((max(1, laws.state_rows(law)), n))
    rho, e = np.ones(n), np.full(n, 1e-3)
    times = []
    for k in range(STEPS):
        start = time.process_time_ns()
        update(law, strain * np.cos(0.7 * k), stress, state, rho, e, 1.0)
        times.append((time.process_time_ns() - start) / n)
    assert np.all(np.isfinite(stress))
    return float(np.median(times))


def cases() -> dict[str, laws.Law]:
    """Every law, of one stiffness [GPa]."""
    young, poisson, bulk, shear = 100.0, 0.25, 200.0 / 3.0, 40.0
    sand = laws.CapHardening(0.066, 0.67, 0.189)

    def cap(**changed: object) -> laws.Law:
        given = {"gamma": 0.18, "decay": 0.67, "ratio": 2.5, "hardening": sand} | changed
        return laws.cap(bulk, shear, 0.25, **given)  # type: ignore[arg-type]

    gruneisen = laws.Gruneisen(1.0, 8.0, 1.5, 0.0, 0.0, 2.0, 0.5)
    points = laws.table([[0.0, 0.1], [0.01, 0.12], [0.1, 0.2], [1.0, 0.3]], shear)
    plastic = laws.von_mises(young, poisson, 0.1, 1.0)
    return {
        "orthotropic": laws.orthotropic((100.0, 50.0, 20.0), (0.3, 0.2, 0.05), (30.0, 20.0, 10.0)),
        "elastic": laws.Elastic.from_engineering(young, poisson),
        "von Mises, isotropic": plastic,
        "von Mises, mixed": laws.von_mises(young, poisson, 0.1, 1.0, 0.5),
        "von Mises, failing": laws.failing(plastic, 1e9),
        "von Mises, power": laws.von_mises_curve(young, poisson, laws.power(0.1, 0.2, 0.3)),
        "von Mises, power, mixed": laws.von_mises_curve(young, poisson, laws.power(0.1, 0.2, 0.3), 0.5),
        "von Mises, table": laws.von_mises_curve(young, poisson, points),
        "von Mises, table and rate": laws.von_mises_curve(young, poisson, points, rate=1.0, exponent=5.0),
        "cap, elliptic": cap(),
        "cap, flat": cap(ratio=0.0),
        "cap, rock": cap(soil=False),
        "cap, kinematic": cap(rate=20.0, size=0.03),
        "Drucker-Prager": laws.drucker_prager_soil(young, poisson, 0.1, 30.0, 10.0),
        "Mohr-Coulomb": laws.mohr_coulomb(young, poisson, 0.1, 30.0, 10.0),
        "Cam-clay": laws.cam_clay(young, poisson, 1.1, 0.15, 0.03, 0.4, 0.9),
        "Perzyna": laws.perzyna(young, poisson, 0.1, 0.1, rate=0.01, power=2.0),
        "fluid, Tait": laws.fluid(laws.Tait(1.0, 10.0, 7.0)),
        "fluid, viscous gas": laws.fluid(laws.PerfectGas(1.4), viscosity=0.1),
        "hydro, Gruneisen": laws.hydro(shear, laws.Linear(0.1, 1.0), gruneisen),
        "hydro, table, spall 2": laws.hydro(shear, points, gruneisen, spall=2, cutoff=-1e3),
    }


def main() -> None:
    """A line for each law."""
    n = int(sys.argv[1]) if len(sys.argv) > 1 else 20_000
    print(f"{'law':28s} elastic  flowing  compile  with tangent ({n} points; ns, ns, s, ns, ns)")
    wanted = sys.argv[2] if len(sys.argv) > 2 else ""
    for name, law in ((name, law) for name, law in cases().items() if wanted in name):
        before = compile_seconds()
        elastic = nanoseconds(law, n, 1e-6)
        compiling = compile_seconds() - before
        flowing = nanoseconds(law, n, 2e-3)
        print(f"{name:28s} {elastic:7.1f} {flowing:8.1f} {compiling:8.2f}", end="", flush=True)
        both = [nanoseconds(law, n, size, tangents_of_all) for size in (1e-6, 2e-3)]
        print(f" {both[0]:7.1f} {both[1]:8.1f}")


if __name__ == "__main__":
    main()
