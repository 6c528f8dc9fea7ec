"""Closed-form solutions against the stored reference values, and against their own limits."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from zrno.solvers import exact


def rows(shared: Path, name: str) -> list[dict[str, str]]:
    with (shared / "reference" / "sph" / f"{name}.csv").open() as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def test_bar_wave_speeds_and_stresses(shared: Path) -> None:
    for row in rows(shared, "bar_wave"):
        given = {"young": float(row["E_Pa"]), "poisson": float(row["nu"]), "density": float(row["rho"])}
        for state, speed, stress in (
            ("stress", "c_bar_m_s", "stress_per_m_s_uniaxial_stress_Pa"),
            ("strain", "c_longitudinal_m_s", "stress_per_m_s_uniaxial_strain_Pa"),
            ("plate", "c_plate_m_s", None),
        ):
            wave = exact.BarWave(**given, length=1.0, speed=1.0, state=state)
            assert wave.wave_speed() == pytest.approx(float(row[speed]), rel=1e-12)
            if stress:
                assert wave.stress() == pytest.approx(float(row[stress]), rel=1e-12)


def test_impact_of_two_cylinders(shared: Path) -> None:
    for row in rows(shared, "cylinder_impact_10ms"):
        given = {"young": float(row["E_Pa"]), "poisson": float(row["nu"]), "density": float(row["rho"])}
        for state, column in (
            ("strain", "early_interface_stress_Pa_relvel20(rho*cl*v)"),
            ("stress", "late_bar_stress_Pa"),
        ):
            wave = exact.BarWave(**given, length=0.03, speed=10.0, state=state)
            assert wave.stress() == pytest.approx(float(row[column]), rel=1e-12)


def test_bar_wave_pulse_has_the_momentum_of_the_rebound() -> None:
    wave = exact.BarWave(young=4.0, density=1.0, length=3.0, speed=0.5, distance=1.0)
    assert (wave.stress(), wave.duration(), wave.arrival()) == (1.0, 3.0, 0.5)
    time = np.array([-0.1, 0.0, 2.9, 3.1])
    assert wave.pulse(time).tolist() == [0.0, 1.0, 1.0, 0.0]
    assert wave.stress() * wave.duration() == 2 * wave.density * wave.length * wave.speed


def test_oscillating_plate(shared: Path) -> None:
    for row in rows(shared, "oscillating_plate"):
        plate = exact.OscillatingPlate(
            length=float(row["L_m"]), thickness=float(row["H_m"]), young=float(row["E_Pa"]), poisson=float(row["nu"]),
            density=float(row["rho"]),
        )  # fmt: skip
        assert plate.omega() == pytest.approx(float(row["omega_rad_s"]), rel=1e-6)
        assert plate.period() == pytest.approx(float(row["period_s"]), rel=1e-6)


def test_a_thick_plate_is_slower_than_a_thin_one() -> None:
    """0.8 % at H/L = 0.1, nu 0.22, 1.0 % at nu 0.40, as the reference page has it; in the limit they are the same."""

    def slower(thickness: float, poisson: float) -> float:
        plate = exact.OscillatingPlate(length=0.2, thickness=thickness, young=2e6, poisson=poisson, density=1000.0)
        return plate.thick_period() / plate.period() - 1.0

    assert slower(0.02, 0.22) == pytest.approx(0.008, abs=0.0005)
    assert slower(0.02, 0.40) == pytest.approx(0.010, abs=0.0005)
    assert slower(0.01, 0.40) == pytest.approx(slower(0.02, 0.40) / 4.0, rel=0.02)
    assert 0.0 < slower(1e-4, 0.3) < 1e-6
    with pytest.raises(ValueError, match="expected less beside the length"):
        slower(2.0, 0.3)


def test_verney_shell(shared: Path) -> None:
    for row in rows(shared, "verney_shell"):
        shell = exact.VerneyShell(
            shape=row["shape"], inner=float(row["a0_m"]), outer=float(row["b0_m"]), density=float(row["rho"]),
            yield_stress=float(row["Y_Pa"]), speed=float(row["initial_inner_velocity_m_s(inward)"]),
        )  # fmt: skip
        assert shell.inner_radius() == pytest.approx(float(row["final_inner_radius_m"]), rel=1e-6)
        assert shell.outer_radius() == pytest.approx(float(row["final_outer_radius_m"]), rel=1e-6)


@pytest.mark.parametrize("shape", ["cylinder", "sphere"])
def test_a_shell_that_is_fast_enough_closes_and_keeps_its_volume(shape: str) -> None:
    shell = exact.VerneyShell(inner=1.0, outer=2.0, density=1.0, yield_stress=1.0, speed=100.0, shape=shape)
    m = 2 if shape == "cylinder" else 3
    assert shell.inner_radius() == 0.0
    assert shell.outer_radius() ** m == pytest.approx(2.0**m - 1.0)


def test_column_collapse(shared: Path) -> None:
    for row in rows(shared, "column_collapse_scaling"):
        aspect = float(row["aspect_hi_over_ri"])
        for geometry, growth, height in (
            ("axisymmetric", "axisym_runout_(rinf-ri)/ri", "axisym_hinf_over_hi"),
            ("plane", "2D_channel_runout_(dinf-di)/di", "2D_channel_hinf_over_hi"),
        ):
            column = exact.ColumnCollapse(height=0.3 * aspect, width=0.3, geometry=geometry)
            assert column.run_out() == pytest.approx(0.3 * (1 + float(row[growth])), rel=1e-12)
            assert column.final_height() == pytest.approx(0.3 * aspect * float(row[height]), rel=1e-12)


def test_spreading_takes_as_long_as_a_few_free_falls() -> None:
    assert exact.ColumnCollapse(height=4.0, width=1.0, gravity=1.0).time() == pytest.approx(6.6)
    assert exact.ColumnCollapse(height=4.0, width=1.0, gravity=1.0, geometry="axisymmetric").time() == 6.0


def test_hydrostatic_column() -> None:
    column = exact.Hydrostatic(density=1000.0, gravity=10.0, height=2.0, top=1.0)
    z = np.array([-1.0, 0.0, 1.0, 2.0])
    assert column.pressure(z).tolist() == [20000.0, 10000.0, 0.0, 0.0]
    assert column.stress(z)[0] == -column.bottom()
    assert column.mean() == pytest.approx(column.pressure(np.linspace(-1.0, 1.0, 5)).mean())


def test_hugoniot(shared: Path) -> None:
    constants = {"Al": (2785.0, 5328.0, 1.338), "steel": (7900.0, 4600.0, 1.49)}
    for row in rows(shared, "mie_gruneisen_hugoniot"):
        density, c0, slope = constants[row["material"]]
        shock = exact.Hugoniot(density=density, c0=c0, slope=slope, speed=float(row["up_m_s"]))
        found = (shock.shock_speed(), shock.pressure(), shock.shocked_density(), shock.energy())
        stored = tuple(float(row[name]) for name in ("Us_m_s", "P_Pa", "rho", "e_J_kg"))
        assert found == pytest.approx(stored, rel=1e-12)


def test_taylor_bar(shared: Path) -> None:
    for row in rows(shared, "taylor_bar_taylor1948"):
        rod = exact.TaylorBar(
            start=float(row["L0_mm"]), density=float(row["rho"]), yield_stress=float(row["Y_Pa"]), speed=float(row["v"])
        )
        assert rod.ratio() == pytest.approx(float(row["Lf_over_L0_WilkinsGuinan"]), rel=1e-12)
        assert rod.length() == pytest.approx(float(row["Lf_mm"]), rel=1e-12)


@pytest.mark.parametrize(
    ("name", "values", "message"),
    [
        ("bar_wave", {"young": 0, "density": 1, "length": 1, "speed": 1}, "young is 0; expected more than 0"),
        ("bar_wave", {"young": 1, "density": 1, "length": 1, "speed": 1, "poisson": 0.5}, "poisson is 0.5"),
        ("bar_wave", {"young": 1, "density": 1, "length": 1, "speed": 1, "state": "x"}, "one of stress, plate, strain"),
        ("verney_shell", {"inner": 2, "outer": 1, "density": 1, "yield_stress": 1, "speed": 1}, "more than inner"),
        ("taylor_bar", {"start": 1, "density": 1, "yield_stress": 1, "speed": 1, "front": 1}, "less than 1"),
    ],
)
def test_parameters_are_checked(name: str, values: dict[str, float], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        exact.SOLUTIONS[name](**values)


def test_every_solution_gives_what_it_names() -> None:
    for solution in exact.SOLUTIONS.values():
        assert solution.SCALARS
        assert all(callable(getattr(solution, name)) for name in (*solution.SCALARS, *solution.CURVES))
