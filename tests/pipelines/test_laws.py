"""Materials by name become laws of the solvers: each constant where it belongs, and a word for those that are none."""

from __future__ import annotations

import contextlib
import math
import re
from typing import Any

import numpy as np
import pytest

from zrno.pipelines.laws import initial_energy, law_of, soil_of, structural_law_of
from zrno.pipelines.method import Soil
from zrno.solvers import materials as laws
from zrno.solvers.errors import Unsupported
from zrno.solvers.materials.point import Point
from zrno.translators.laws import EQUATIONS_OF_STATE, LAWS
from zrno.translators.model import Curve, Eos, Material

MODULI = {"E": 210.0, "nu": 0.3}
CAP = {"K": 88.62, "G": 29.23, "alpha": 0.02138, "theta": 0.292, "R": 3.0, "D": 0.752, "W": 0.0313}
SOIL = {"c": 1.0, "phi": 30.0}
WATER = Eos(1, "", "murnaghan", {"B": 0.3, "gamma": 7.0})
TABLE = np.array([[0.0, 1.0], [0.1, 2.0]])


def built(law: str, eos: Eos | None = None, tables: dict[str, Any] | None = None, **parameters: float) -> laws.Law:
    return law_of(Material(1, "m", law, 2.0, parameters, tables=tables or {}), eos, {})


CASES: dict[str, tuple[laws.Law, laws.Law]] = {
    "elastic": (built("elastic", **MODULI), laws.Elastic.from_engineering(210.0, 0.3)),
    "von Mises": (
        built("von_mises", **MODULI, yield_stress=1.0, tangent_modulus=2.0, beta=0.5),
        laws.von_mises(210.0, 0.3, 1.0, 2.0, 0.5),
    ),
    "failing": (
        built("von_mises", **MODULI, yield_stress=1.0, failure_strain=0.2),
        laws.failing(laws.von_mises(210.0, 0.3, 1.0), 0.2),
    ),
    "rate": (
        built("von_mises", **MODULI, yield_stress=1.0, tangent_modulus=2.0, rate_C=40.0, rate_p=5.0),
        laws.von_mises_curve(210.0, 0.3, laws.Linear(1.0, 420.0 / 208.0), rate=40.0, exponent=5.0),
    ),
    "power": (
        built("von_mises_power", **MODULI, yield_stress=1.0, Cy=2.0, M=0.3),
        laws.von_mises(210.0, 0.3, 1.0, 420.0 / 212.0, 0.3),
    ),
    "power with an exponent": (
        built("von_mises_power", **MODULI, yield_stress=1.0, Cy=2.0, n=0.4, M=0.3),
        laws.von_mises_curve(210.0, 0.3, laws.power(1.0, 2.0, 0.4), 0.3),
    ),
    "kinematic with a rate that has nothing to harden": (
        built("von_mises", **MODULI, yield_stress=1.0, beta=0.0, rate_C=40.0, rate_p=5.0),
        laws.von_mises_curve(210.0, 0.3, laws.Linear(1.0, 0.0), rate=40.0, exponent=5.0),
    ),
    "fluid": (
        built("fluid", WATER, pressure_cutoff=-0.1, viscosity=0.2),
        laws.fluid(laws.Tait(2.0, 0.3, 7.0), viscosity=0.2, cutoff=-0.1),
    ),
    "hydro": (
        built("hydro", WATER, G=80.0, yield_stress=1.0, hardening_modulus=2.0, a1=0.1, a2=0.2, spall=3.0,
              pressure_cutoff=-1.0, failure_strain=0.4),
        laws.hydro(80.0, laws.Linear(1.0, 2.0), laws.Tait(2.0, 0.3, 7.0), a1=0.1, a2=0.2, spall=3, cutoff=-1.0,
                   failure=0.4),
    ),
    "hydro by default": (
        built("hydro", WATER, G=80.0), laws.hydro(80.0, laws.Linear(0.0, 0.0), laws.Tait(2.0, 0.3, 7.0)),
    ),
    "cap": (
        built("cap", **CAP, ftype=2.0, tension_cutoff=-0.01),
        laws.cap(88.62, 29.23, 0.02138, hardening=laws.CapHardening(0.0313, 0.752, 0.0), theta=0.292, ratio=3.0,
                 soil=False, tension=-0.01),
    ),
    "kinematic cap": (
        built("cap", **CAP, C=1.0, N=0.01, gamma=0.01, beta=0.5, X0=0.1),
        laws.cap(88.62, 29.23, 0.02138, hardening=laws.CapHardening(0.0313, 0.752, 0.1), theta=0.292, ratio=3.0,
                 gamma=0.01, decay=0.5, rate=1.0, size=0.01),
    ),
    "Drucker-Prager": (
        built("drucker_prager", **MODULI, k=1.0, alpha=0.2, tension_cutoff=-0.5),
        laws.drucker_prager(210.0, 0.3, 1.0, 0.2, tension=-0.5),
    ),
    "Drucker-Prager with a cap": (
        built("drucker_prager", **MODULI, k=1.0, alpha=0.2, D=0.1, W=0.2, X0=4.0, R=2.0),
        laws.cap(175.0, 210.0 / 2.6, 1.0, hardening=laws.CapHardening(0.2, 0.1, 4.0), theta=0.2, ratio=2.0),
    ),
    "Drucker-Prager by angles": (
        built("drucker_prager_soil", **MODULI, **SOIL, psi=10.0),
        laws.drucker_prager_soil(210.0, 0.3, 1.0, 30.0, 10.0),
    ),
    "Mohr-Coulomb": (
        built("mohr_coulomb", **MODULI, **SOIL, psi=10.0), laws.mohr_coulomb(210.0, 0.3, 1.0, 30.0, 10.0),
    ),
    "Cam-clay": (
        built("cam_clay", **MODULI, **{"M": 1.1, "lambda": 0.15, "kappa": 0.03, "pc": 4.0, "e0": 0.9}),
        laws.cam_clay(210.0, 0.3, 1.1, 0.15, 0.03, 4.0, 0.9),
    ),
}  # fmt: skip


def flat(law: Any) -> list[Any]:
    return [x for part in law for x in flat(part)] if isinstance(law, tuple) else [law]


@pytest.mark.parametrize("name", CASES)
def test_each_constant_is_where_it_belongs(name: str) -> None:
    got, wanted = CASES[name]
    assert type(got) is type(wanted)
    assert flat(got) == pytest.approx(flat(wanted), rel=1e-12)


def test_tables_come_from_the_material_or_by_curve() -> None:
    material = Material(1, "", "von_mises", 2.0, {**MODULI, "yield_stress": 0.0}, curves={"hardening": 7})
    with pytest.raises(ValueError, match="yield stress"):
        law_of(material, None, {})
    material.parameters["yield_stress"] = 1.0
    law = law_of(material, None, {7: Curve(7, "", TABLE)})
    assert isinstance(law, laws.VonMisesCurve)
    assert law.rate == math.inf
    assert np.array_equal(law.hardening.stress, [1.0, 2.0])  # type: ignore[union-attr]
    law = built("hydro", WATER, {"hardening": TABLE}, G=80.0)
    assert np.array_equal(law.hardening.strain, [0.0, 0.1])  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("law", "given", "wanted"),
    [
        ("linear_polynomial", {"C1": 3.0, "C6": 0.5}, laws.LinearPolynomial(2.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.5)),
        ("gruneisen", {"C": 3.0, "S1": 1.5, "S2": 0.1, "S3": 0.2, "gamma0": 2.0, "a": 0.4},
         laws.Gruneisen(2.0, 3.0, 1.5, 0.1, 0.2, 2.0, 0.4)),
        ("perfect_gas", {"gamma": 1.4}, laws.PerfectGas(1.4)),
        ("murnaghan", {"B": 0.3, "gamma": 7.0}, laws.Tait(2.0, 0.3, 7.0)),
        ("mie_gruneisen", {"C": 3.0, "S": 1.5, "gamma0": 2.0, "b": 1.0}, laws.MieGruneisen(2.0, 3.0, 1.5, 2.0, 1.0)),
    ],
)  # fmt: skip
def test_equations_of_state(law: str, given: dict[str, float], wanted: laws.Eos) -> None:
    built_law = built("fluid", Eos(1, "", law, given))
    assert built_law == laws.fluid(wanted, cutoff=0.0)
    assert initial_energy(Eos(1, "", law, {"E0": 3.0}), 2.0) == 1.5
    assert initial_energy(None, 2.0) == 0.0


def test_cut_offs_of_either_sign() -> None:
    """A pressure cut-off is a tension; a tension cut-off that is a pressure is none at all."""
    for sign in (1.0, -1.0):
        assert built("fluid", WATER, pressure_cutoff=sign * 3.0) == laws.fluid(laws.Tait(2.0, 0.3, 7.0), cutoff=-3.0)
        assert built("hydro", WATER, G=1.0, pressure_cutoff=sign * 3.0).cutoff == -3.0  # type: ignore[union-attr]
    assert built("cap", **CAP, tension_cutoff=0.01) == built("cap", **CAP)


def test_every_law_is_built_or_refused_by_name() -> None:
    for law in LAWS:
        given = {name: 0.25 for name, value in LAWS[law].parameters.items() if value is None}
        with contextlib.suppress(Unsupported, ValueError):
            built(law, WATER, **given)
    for law in EQUATIONS_OF_STATE:
        with pytest.raises(ValueError, match=r"needs|must"):
            built("fluid", Eos(1, "", law, dict.fromkeys(EQUATIONS_OF_STATE[law].parameters, 0.0)))


@pytest.mark.parametrize(
    ("law", "given", "eos", "error", "wrong"),
    [
        ("rigid", MODULI, None, Unsupported, "rigid is not computed"),
        ("soil_foam", {"G": 1.0, "K": 1.0}, None, Unsupported, "soil_foam is not computed"),
        ("elastic", {"E": 1.0}, None, ValueError, "nu is missing"),
        ("elastic", {"E": 1.0, "nu": 0.5}, None, ValueError, "Poisson"),
        ("fluid", {}, None, ValueError, "equation of state"),
        ("fluid", {}, Eos(1, "", "murnaghan", {"B": 0.3, "gamma": 7.0, "V0": 0.5}), Unsupported, "V0"),
        ("hydro", {"G": 1.0, "spall": 1.5}, WATER, ValueError, "spall"),
        ("cap", {**CAP, "ftype": 3.0}, None, ValueError, "ftype"),
        ("cap", {**CAP, "W": 0.0}, None, ValueError, "W 0.0"),
        ("von_mises_power", {**MODULI, "yield_stress": 1.0, "Cy": 1.0, "n": -0.5}, None, ValueError, "exponent"),
        ("orthotropic", {"Ex": 1.0}, None, Unsupported, "orthotropic is not computed"),  # of particles
        ("von_mises", {**MODULI, "yield_stress": 1.0, "tangent_modulus": 1.0, "beta": 0.5, "rate_C": 1.0}, None,
         Unsupported, "kinematic"),
        ("drucker_prager_soil", {**MODULI, **SOIL, "shape": 0.8}, None, Unsupported, "shape"),
        ("drucker_prager", {"E": -1.0, "nu": 0.3, "k": 1.0, "D": 1.0, "W": 1.0}, None, ValueError, "Young"),
    ],
)  # fmt: skip
def test_what_makes_no_sense_and_what_is_not_computed(
    law: str, given: dict[str, float], eos: Eos | None, error: type[Exception], wrong: str
) -> None:
    with pytest.raises(error, match=re.escape(wrong)):
        built(law, eos, **given)


def test_an_orthotropic_material_of_finite_elements_has_its_axes() -> None:
    names = LAWS["orthotropic"].parameters
    values = (3.0, 2.0, 1.0, 0.2, 0.1, 0.05, 0.8, 0.6, 0.4)
    material = Material(1, "m", "orthotropic", 2.0, dict(zip(names, values, strict=True)))
    turned = laws.axes_of((0.0, 2.0, 0.0), (0.0, 1.0, 3.0))
    assert turned.tolist() == [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]
    straight, other = (structural_law_of(material, {}, axes).stiffness for axes in (None, turned))  # type: ignore[union-attr]
    order = [1, 2, 0, 4, 5, 3]  # the law's x is y now, its y is z
    np.testing.assert_allclose(other[np.ix_(order, order)], straight, atol=1e-12)
    with pytest.raises(ValueError, match="parallel"):
        laws.axes_of((1.0, 0.0, 0.0), (2.0, 0.0, 0.0))
    with pytest.raises(ValueError, match="positive"):
        structural_law_of(Material(1, "m", "orthotropic", 2.0, {"Ex": 1.0}), {}, None)
    assert structural_law_of(Material(1, "m", "elastic", 2.0, MODULI), {}, turned) == CASES["elastic"][1]


def test_mixed_hardening_by_a_table() -> None:
    law = built("von_mises", tables={"hardening": TABLE}, **MODULI, yield_stress=9.0, beta=0.2)
    assert isinstance(law, laws.VonMisesMixedCurve)
    assert (law.beta, law.hardening.stress.tolist()) == (0.2, [1.0, 2.0])  # type: ignore[union-attr]


def test_a_cut_off_of_tension_of_a_scenes_soil() -> None:
    """The greatest mean tension; pulled on all sides, clay without a friction angle bears that and no more."""
    material = Material(1, "clay", "elastic", 2.0, MODULI)
    clay = soil_of(material, Soil(law="drucker_prager_soil", c=1.0, phi=0.0, tension=0.5))
    point = Point(clay)
    point.move(np.array([[0.01, 0.01, 0.01, 0.0, 0.0, 0.0]] * 3))
    assert point.stress[:3].tolist() == pytest.approx([0.5] * 3)
    assert soil_of(material, Soil(law="drucker_prager_soil", phi=30.0, tension=0.5)).tension == 0.0  # the apex
    with pytest.raises(ValueError, match="a cut-off of tension is for drucker_prager_soil"):
        soil_of(material, Soil(law="mohr_coulomb", phi=30.0, tension=0.0))
