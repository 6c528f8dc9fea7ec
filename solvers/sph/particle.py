"""What happens at a particle in a step, without its neighbours: material, motion."""

from __future__ import annotations

import numpy as np
from numba.extending import overload

from ..jit import kernel
from ..materials.law import JIT_OPTIONS, bulk_modulus, rotate_state, stress_update, wave_speed
from ..materials.rotation import first_order_spin, spin_rotation
from .nominal import LENGTH

INSTANT = 1e-300  # a duration that divides no strain rate by zero
DRIVEN = 8  # a bit of `fixed`: the velocity is given from outside


@kernel
def constitutive(
    i0, i1, z, number, law, dt, correction, density_rate, stress_rate, heat, wave, hoop, arrays, numbers
):  # fmt: skip
    """Density, rotation, stress, viscosity and energy of the particles of one material in a block.

    The original program rotates by half the spin, to first order. The optional arguments are rows of `arrays`, or None
    where a run has no such thing.
    """
    q = numbers.viscous[number]
    material = arrays.material
    gradient = arrays.gradient
    stress = arrays.stress
    s = arrays.s
    density = arrays.density
    state = arrays.state
    whole = arrays.hourglass.shape[0] > 0
    for i in range(i0, i1):
        if material[i] != number:
            continue
        if z is not None:
            d_xx = gradient[0, i] * dt
            d_yy = gradient[4, i] * dt
            d_zz = gradient[8, i] * dt
            d_xy = 0.5 * (gradient[1, i] + gradient[3, i]) * dt
            d_yz = 0.5 * (gradient[5, i] + gradient[7, i]) * dt
            d_zx = 0.5 * (gradient[6, i] + gradient[2, i]) * dt
            w_xy = 0.5 * (gradient[1, i] - gradient[3, i]) * dt
            w_yz = 0.5 * (gradient[5, i] - gradient[7, i]) * dt
            w_zx = 0.5 * (gradient[6, i] - gradient[2, i]) * dt
            o_xy = stress[3, i]
            o_yz = stress[4, i]
            o_zx = stress[5, i]
        else:
            d_xx = gradient[0, i] * dt
            d_yy = gradient[3, i] * dt
            d_zz = 0.0
            if hoop is not None:
                d_zz = arrays.u[i] / arrays.x_half[i] * dt
            d_xy = 0.5 * (gradient[1, i] + gradient[2, i]) * dt
            d_yz = 0.0
            d_zx = 0.0
            w_xy = 0.5 * (gradient[1, i] - gradient[2, i]) * dt
            w_yz = 0.0
            w_zx = 0.0
            o_xy = stress[3, i]
            o_yz = 0.0
            o_zx = 0.0
        o_xx = stress[0, i]
        o_yy = stress[1, i]
        o_zz = stress[2, i]
        volumetric = d_xx + d_yy + d_zz
        rho = density[i] * (1.0 - volumetric)
        if (
            not numbers.original
        ):  # of the middle of the step, as the work is: an equation of state then conserves energy
            rho = density[i] * (1.0 - 0.5 * volumetric) / (1.0 + 0.5 * volumetric)
        if density_rate is not None:
            rho += density_rate[i] * dt
        if stress_rate is not None and bulk_modulus(law) > 0.0:  # else pressure and density drift apart
            mean = (stress_rate[0, i] + stress_rate[1, i] + stress_rate[2, i]) / 3.0
            rho -= rho * mean * dt / bulk_modulus(law)
        rho = min(max(rho, q[2]), q[3])
        if numbers.original:
            w_xy *= 0.5
            w_yz *= 0.5
            w_zx *= 0.5
            r_xx, r_yy, r_zz, r_xy, r_yz, r_zx = first_order_spin(w_xy, w_yz, w_zx, o_xx, o_yy, o_zz, o_xy, o_yz, o_zx)
        else:
            r_xx, r_yy, r_zz, r_xy, r_yz, r_zx = spin_rotation(w_xy, w_yz, w_zx, o_xx, o_yy, o_zz, o_xy, o_yz, o_zx)
        if stress_rate is not None:
            r_xx += stress_rate[0, i] * dt
            r_yy += stress_rate[1, i] * dt
            r_zz += stress_rate[2, i] * dt
            r_xy += stress_rate[3, i] * dt
            if z is not None:
                r_yz += stress_rate[4, i] * dt
                r_zx += stress_rate[5, i] * dt
        rotate_state(law, w_xy, w_yz, w_zx, state, i)
        n_xx, n_yy, n_zz, n_xy, n_yz, n_zx, plastic = stress_update(
            law, d_xx, d_yy, d_zz, d_xy, d_yz, d_zx, r_xx, r_yy, r_zz, r_xy, r_yz, r_zx,
            rho, arrays.energy[i], dt, state, i,
        )  # fmt: skip
        viscosity = 0.0
        if volumetric < 0.0 and dt > INSTANT:  # at the very start nothing has closed yet
            length = arrays.h[i]
            if whole and arrays.hourglass[LENGTH, i] > 0.0:
                length = arrays.hourglass[LENGTH, i]
            closing = -volumetric / dt * length
            c = numbers.wave[number]
            if wave is not None:
                c = wave[i]
            viscosity = rho * closing * (q[0] * c + q[1] * closing)
        work = 0.5 * ((o_xx + n_xx) * d_xx + (o_yy + n_yy) * d_yy + (o_zz + n_zz) * d_zz)
        work += (o_xy + n_xy) * d_xy + (o_yz + n_yz) * d_yz + (o_zx + n_zx) * d_zx
        specific = 2.0 / (rho + density[i])
        warmed = -0.5 * (arrays.viscosity[i] + viscosity) * volumetric  # the mean over the step, as of the stress
        arrays.viscosity[i] = viscosity
        arrays.energy[i] += (work + warmed) * specific
        arrays.dissipated[i] += (plastic + warmed) * specific
        if heat is not None:
            arrays.energy[i] += heat[i] * dt
            arrays.dissipated[i] += heat[i] * dt
        density[i] = rho
        if wave is not None:
            wave[i] = wave_speed(law, rho, arrays.energy[i], state, i)
        stress[0, i] = n_xx
        stress[1, i] = n_yy
        stress[2, i] = n_zz
        stress[3, i] = n_xy
        inverse = 1.0 if numbers.mixed else 1.0 / (rho * rho)
        n_xx = (n_xx - viscosity) * inverse
        n_yy = (n_yy - viscosity) * inverse
        n_xy *= inverse
        if z is not None:
            stress[4, i] = n_yz
            stress[5, i] = n_zx
            n_zz = (n_zz - viscosity) * inverse
            n_yz *= inverse
            n_zx *= inverse
            if correction is not None:
                b_xx = correction[0, i]
                b_yy = correction[1, i]
                b_zz = correction[2, i]
                b_xy = correction[3, i]
                b_yz = correction[4, i]
                b_zx = correction[5, i]
                s[0, i] = n_xx * b_xx + n_xy * b_xy + n_zx * b_zx
                s[1, i] = n_xx * b_xy + n_xy * b_yy + n_zx * b_yz
                s[2, i] = n_xx * b_zx + n_xy * b_yz + n_zx * b_zz
                s[3, i] = n_xy * b_xx + n_yy * b_xy + n_yz * b_zx
                s[4, i] = n_xy * b_xy + n_yy * b_yy + n_yz * b_yz
                s[5, i] = n_xy * b_zx + n_yy * b_yz + n_yz * b_zz
                s[6, i] = n_zx * b_xx + n_yz * b_xy + n_zz * b_zx
                s[7, i] = n_zx * b_xy + n_yz * b_yy + n_zz * b_yz
                s[8, i] = n_zx * b_zx + n_yz * b_yz + n_zz * b_zz
            else:
                s[0, i] = n_xx
                s[1, i] = n_yy
                s[2, i] = n_zz
                s[3, i] = n_xy
                s[4, i] = n_yz
                s[5, i] = n_zx
        elif correction is not None:
            b_xx = correction[0, i]
            b_yy = correction[1, i]
            b_xy = correction[2, i]
            s[0, i] = n_xx * b_xx + n_xy * b_xy
            s[1, i] = n_xx * b_xy + n_xy * b_yy
            s[2, i] = n_xy * b_xx + n_yy * b_xy
            s[3, i] = n_xy * b_xy + n_yy * b_yy
            if hoop is not None:
                s[2, i] *= arrays.x[i]
                s[3, i] *= arrays.x[i]
        elif hoop is not None:  # the axial row with the radius, see `rings`
            s[0, i] = n_xx
            s[1, i] = n_xy
            s[2, i] = n_xy * arrays.x[i]
            s[3, i] = n_yy * arrays.x[i]
        else:
            s[0, i] = n_xx
            s[1, i] = n_yy
            s[2, i] = n_xy


def each_law(laws, number, i0, i1, z, dt, correction, density_rate, stress_rate, heat, wave, hoop, arrays, numbers):
    """`constitutive` for every body's law; a tuple of different types is unrolled by recursion."""
    raise NotImplementedError("called from jitted code only")


@overload(each_law, jit_options=JIT_OPTIONS)
def _unrolled(laws, number, i0, i1, z, dt, correction, density_rate, stress_rate, heat, wave, hoop, arrays, numbers):
    if len(laws) == 0:

        def none(laws, number, i0, i1, z, dt, correction, density_rate, stress_rate, heat, wave, hoop, arrays, numbers):
            pass

        return none

    def each(laws, number, i0, i1, z, dt, correction, density_rate, stress_rate, heat, wave, hoop, arrays, numbers):
        constitutive(
            i0, i1, z, number, laws[0], dt, correction, density_rate, stress_rate, heat, wave, hoop, arrays, numbers
        )
        each_law(
            laws[1:], number + 1, i0, i1, z, dt, correction, density_rate, stress_rate, heat, wave, hoop, arrays,
            numbers,
        )  # fmt: skip

    return each


@kernel
def half_work(i0, i1, z, cx, bx, body_work, dt, arrays, numbers):
    """Work of contact, artificial stress and a changing body force over half a step, with the forces there are now.

    It is done at both ends of a step, with the step's own velocities: together exact as the leap-frog is.
    """
    u, v = arrays.u, arrays.v
    for i in range(i0, i1):
        if cx is not None:
            power = cx[i] * u[i] + arrays.cy[i] * v[i]
            if z is not None:
                power += arrays.cz[i] * arrays.w[i]
            arrays.contact_work[i] += 0.5 * dt * arrays.mass[i] * power
        if bx is not None:
            power = bx[i] * u[i] + arrays.by[i] * v[i]
            if z is not None:
                power += arrays.bz[i] * arrays.w[i]
            arrays.artificial_work[i] += 0.5 * dt * arrays.mass[i] * power
        if body_work is not None:
            power = numbers.body[0] * u[i] + numbers.body[1] * v[i]
            if z is not None:
                power += numbers.body[2] * arrays.w[i]
            body_work[i] += 0.5 * dt * arrays.mass[i] * power


@kernel
def kick(i0, i1, z, cx, bx, body_work, duration, dt, arrays, numbers):
    """v += a duration; directions in the mask `fixed` (bits x y z) do not move, nor change driven velocities.

    dt: the step that begins. Dynamic relaxation then takes its part, and the row `relaxed` has what it took: with v
    before and r v after it, m (1 - r) v . ((1 + r) v - a dt) / 2, so that what the forces do, which is counted with the
    velocities of after, and this close the balance as the leap-frog alone does.
    """
    u, v = arrays.u, arrays.v
    relaxation = numbers.relaxation
    for i in range(i0, i1):
        fixed = arrays.fixed[i]
        if fixed & DRIVEN:
            continue
        if fixed & 1:
            arrays.ax[i] = 0.0
            u[i] = 0.0
        if fixed & 2:
            arrays.ay[i] = 0.0
            v[i] = 0.0
        u[i] += arrays.ax[i] * duration
        v[i] += arrays.ay[i] * duration
        if z is not None:
            if fixed & 4:
                arrays.az[i] = 0.0
                arrays.w[i] = 0.0
            arrays.w[i] += arrays.az[i] * duration
        if relaxation != 1.0:
            power = u[i] * ((1.0 + relaxation) * u[i] - arrays.ax[i] * dt)
            power += v[i] * ((1.0 + relaxation) * v[i] - arrays.ay[i] * dt)
            u[i] *= relaxation
            v[i] *= relaxation
            if z is not None:
                power += arrays.w[i] * ((1.0 + relaxation) * arrays.w[i] - arrays.az[i] * dt)
                arrays.w[i] *= relaxation
            arrays.relaxed[0, i] += 0.5 * arrays.mass[i] * (1.0 - relaxation) * power
    half_work(i0, i1, z, cx, bx, body_work, dt, arrays, numbers)


@kernel
def drift(i0, i1, z, smoothed, h_start, h_list, mirrors, half_support, dt, arrays, numbers):
    """x += v dt, with the smoothed velocities where there are such; smoothing lengths follow the last strain.

    mirrors: None, or (3, 2) coordinates of the symmetry planes (infinite where there is none), which throw back what
    passes them: its image alone does not hold a lonely particle. Returns the largest distance from where the list was
    built, with what the smoothing length has grown since, squared, and the index of a particle that moved further than
    its smoothing length or whose velocity is not a number (-1: none).
    """
    x, y, u, v = arrays.x, arrays.y, arrays.u, arrays.v
    largest = 0.0
    bad = np.int64(-1)
    for i in range(i0, i1):
        ui = u[i]
        vi = v[i]
        wi = 0.0
        if z is not None:
            wi = arrays.w[i]
        if smoothed is not None:
            ui = smoothed[0, i]
            vi = smoothed[1, i]
            if z is not None:
                wi = smoothed[2, i]
            fixed = arrays.fixed[i]
            given = fixed & DRIVEN  # it is where the structure is
            ui = (u[i] if given else 0.0) if fixed & 1 else ui
            vi = (v[i] if given else 0.0) if fixed & 2 else vi
            if z is not None:
                wi = (arrays.w[i] if given else 0.0) if fixed & 4 else wi
        x[i] += ui * dt
        y[i] += vi * dt
        if z is not None:
            z[i] += wi * dt
        if mirrors is not None:
            if not mirrors[0, 0] <= x[i] <= mirrors[0, 1]:
                x[i] = 2.0 * (mirrors[0, 0] if x[i] < mirrors[0, 0] else mirrors[0, 1]) - x[i]
                ui = -ui
                u[i] = -u[i]
            if not mirrors[1, 0] <= y[i] <= mirrors[1, 1]:
                y[i] = 2.0 * (mirrors[1, 0] if y[i] < mirrors[1, 0] else mirrors[1, 1]) - y[i]
                vi = -vi
                v[i] = -v[i]
            if z is not None and not mirrors[2, 0] <= z[i] <= mirrors[2, 1]:
                z[i] = 2.0 * (mirrors[2, 0] if z[i] < mirrors[2, 0] else mirrors[2, 1]) - z[i]
                wi = -wi
                arrays.w[i] = -arrays.w[i]
        arrays.x_half[i] = x[i] - 0.5 * dt * ui
        arrays.y_half[i] = y[i] - 0.5 * dt * vi
        speed2 = ui * ui + vi * vi
        moved2 = (x[i] - arrays.x_list[i]) ** 2 + (y[i] - arrays.y_list[i]) ** 2
        if z is not None:
            arrays.z_half[i] = z[i] - 0.5 * dt * wi
            speed2 += wi * wi
            moved2 += (z[i] - arrays.z_list[i]) ** 2
        if h_list is not None:
            if numbers.h_option == 1:
                trace = arrays.gradient[0, i]
                if z is not None:
                    trace += arrays.gradient[4, i] + arrays.gradient[8, i]
                else:
                    trace += arrays.gradient[3, i]
                arrays.h[i] *= 1.0 + trace * dt / numbers.dimension
            if numbers.h_option == 2:
                arrays.h[i] = h_start[i] * arrays.density[i] ** (-1.0 / numbers.dimension)
            grown = max(0.0, arrays.h[i] - h_list[i])
            moved2 = (np.sqrt(moved2) + half_support * grown) ** 2
        if not speed2 * dt * dt <= arrays.h[i] * arrays.h[i]:
            bad = i
        largest = max(largest, moved2)
    return largest, float(bad)
