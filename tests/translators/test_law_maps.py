"""Laws for laws: the same stress where the same is promised, and a word where something is lost."""

from __future__ import annotations

import math

import numpy as np
import pytest

from zrno.translators.law_maps import as_known
from zrno.translators.laws import LAWS, bulk_and_shear, engineering
from zrno.translators.model import Curve, Eos, Material
from zrno.translators.report import Report

ALL = {name: tuple(law.parameters) for name, law in LAWS.items()}


def material(law: str, **parameters: float) -> Material:
    return Material(1, "m", law, 2.0, parameters)


def only(*laws: str) -> dict[str, tuple[str, ...]]:
    return {law: ALL[law] for law in laws}


def test_the_same_law_loses_nothing() -> None:
    report = Report()
    found = as_known(material("cap", K=3.0, G=1.0, alpha=0.1), only("cap", "elastic"), {}, None, report)
    assert found is not None
    assert (found.law, found.parameters["alpha"], found.parameters["ftype"]) == ("cap", 0.1, 1.0)
    assert not report


def test_parameters_that_the_deck_has_not() -> None:
    report = Report()
    steel = material("von_mises", E=200.0, nu=0.3, yield_stress=1.0, rate_C=40.0, rate_p=5.0)
    found = as_known(steel, {"von_mises": ("E", "nu", "yield_stress", "tangent_modulus", "beta")}, {}, None, report)
    assert found is not None
    assert sorted(found.parameters) == ["E", "beta", "nu", "tangent_modulus", "yield_stress"]
    assert [(i.what, i.count) for i in report.approximated] == [("material parameters", 2)]
    assert "rate_C = 40, rate_p = 5" in report.approximated[0].where


def test_bilinear_hardening_as_a_power_law_and_back() -> None:
    report = Report()
    steel = material("von_mises", E=200.0, nu=0.3, yield_stress=1.0, tangent_modulus=20.0, beta=0.25)
    power = as_known(steel, only("von_mises_power"), {}, None, report)
    assert power is not None
    # stress at a plastic strain of 0.01 by either law: sy + E ET / (E - ET) ep
    assert power.parameters["Cy"] * 0.01 ** power.parameters["n"] == pytest.approx(200 * 20 / 180 * 0.01)
    back = as_known(power, only("von_mises"), {}, None, report)
    assert back is not None
    assert back.parameters["tangent_modulus"] == pytest.approx(20.0)
    assert back.parameters["beta"] == 0.25
    assert not report


def test_a_curved_table_says_how_far_it_is_off() -> None:
    report = Report()
    steel = material("von_mises", E=200.0, nu=0.3)
    steel.curves["hardening"] = 7
    curves = {7: Curve(7, "", np.array([[0.0, 1.0], [0.1, 3.0], [0.2, 4.0]]))}
    found = as_known(steel, only("von_mises"), curves, None, report)
    assert found is not None
    # least squares through the first point: slope (0.1 * 2 + 0.2 * 3) / (0.01 + 0.04) = 16; off by 0.4 at 0.1
    assert found.parameters["tangent_modulus"] == pytest.approx(200 * 16 / 216)
    assert "off by up to 0.4 in stress" in report.approximated[0].where


def test_a_table_that_begins_at_no_stress_still_yields_somewhere() -> None:
    steel = material("von_mises", E=2e5, nu=0.33)
    steel.tables["hardening"] = np.array([[0.0, 0.0], [0.01, 1170.0], [0.04, 1240.0]])
    found = as_known(steel, only("von_mises"), {}, None, Report())
    assert found is not None
    assert found.parameters["yield_stress"] > 300


def test_drucker_prager_meets_mohr_coulomb_in_triaxial_compression() -> None:
    c, phi = 3.0, 30.0
    report = Report()
    soil = as_known(material("mohr_coulomb", E=1.0, nu=0.3, c=c, phi=phi), only("drucker_prager"), {}, None, report)
    assert soil is not None
    sine = math.sin(math.radians(phi))
    side = 5.0  # confining pressure; the axial one at failure by Mohr-Coulomb, compression positive
    axial = side * (1 + sine) / (1 - sine) + 2 * c * math.cos(math.radians(phi)) / (1 - sine)
    root_j2, i1 = (axial - side) / math.sqrt(3.0), axial + 2 * side
    assert root_j2 == pytest.approx(soil.parameters["k"] + soil.parameters["alpha"] * i1, rel=1e-13)
    assert len(report.approximated) >= 1


def test_hydro_takes_its_bulk_modulus_from_the_equation_of_state() -> None:
    report = Report()
    metal = material("hydro", G=80.0, yield_stress=1.0)
    eos = Eos(1, "", "murnaghan", {"B": 20.0, "gamma": 7.0})
    found = as_known(metal, only("von_mises"), {}, eos, report)
    assert found is not None
    assert bulk_and_shear(found.parameters["E"], found.parameters["nu"]) == pytest.approx((140.0, 80.0))
    assert report.approximated
    assert as_known(metal, only("von_mises"), {}, None, Report()) is None


def test_what_has_no_neighbour() -> None:
    report = Report()
    assert as_known(material("soil_foam", G=1.0, K=2.0), only("elastic", "von_mises"), {}, None, report) is None
    assert as_known(material("von_mises", E=1.0, nu=0.0, yield_stress=1.0), only("cap"), {}, None, report) is None
    assert as_known(material(""), only("elastic"), {}, None, report) is None
    assert not report


def test_rigid_is_elastic_and_said() -> None:
    report = Report()
    found = as_known(material("rigid", E=7.0, nu=0.2), only("elastic"), {}, None, report)
    assert found is not None
    assert found.parameters == {"E": 7.0, "nu": 0.2}
    assert "rigid body" in report.approximated[0].where


def test_moduli_there_and_back() -> None:
    assert engineering(*bulk_and_shear(210.0, 0.28)) == pytest.approx((210.0, 0.28), rel=1e-14)
