"""One time step: what happens at a particle, and the order of the phases.

Leap-frog: positions and stresses live at whole steps, velocities at half steps. The invariant between steps,
"synchronised": positions, stresses and accelerations at t, velocities at t - dt_last/2. A step then is
    v += a (dt_last + dt)/2, x += dt v                                     kick and drift, to t + dt
    grad v at x - dt v/2, density, rotation, stress, viscosity, energy     strain
    a, nearest distance, contact, the next dt                              force
`prepare` does the last two once at the start. The original program numbers the same states differently; see `solver`.
"""

from __future__ import annotations

import numpy as np
from numba.extending import overload

from ..jit import kernel
from ..materials.law import JIT_OPTIONS, rotate_state, stress_update
from ..materials.rotation import spin_rotation
from ..threads import barrier, claim, share
from . import pairs

# entries of `progress`, the loop's own memory
TIME, LAST, NEXT, STEPS, PENDING, FIRST, BAD = range(7)
PROGRESS = 7

# why `advance` came back
REACHED, PAUSED, REBUILD, BROKEN, COLLAPSED = range(5)

CHUNK = 256  # particles that a thread takes on at a time

LANDING = 8  # so many steps before a wanted time the step is trimmed to meet it
GROWTH = 1.1  # a step grows by no more than this
COLLAPSE = 1e-7  # a step this small beside the first one will not recover


@kernel
def constitutive(i0, i1, z, number, law, dt, arrays, numbers):
    """Density, rotation, stress, viscosity and energy of the particles of one material in a block.

    The original program rotates by half the spin.
    """
    q = numbers.viscous[number]
    material = arrays.material
    gradient = arrays.gradient
    stress = arrays.stress
    s = arrays.s
    density = arrays.density
    state = arrays.state
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
            d_xy = 0.5 * (gradient[1, i] + gradient[2, i]) * dt
            d_yz = 0.0
            d_zx = 0.0
            w_xy = 0.5 * (gradient[1, i] - gradient[2, i]) * dt
            w_yz = 0.0
            w_zx = 0.0
            o_xy = stress[3, i]
            o_yz = 0.0
            o_zx = 0.0
        if numbers.original:
            w_xy *= 0.5
            w_yz *= 0.5
            w_zx *= 0.5
        o_xx = stress[0, i]
        o_yy = stress[1, i]
        o_zz = stress[2, i]
        volumetric = d_xx + d_yy + d_zz
        rho = min(max(density[i] * (1.0 - volumetric), q[2]), q[3])
        r_xx, r_yy, r_zz, r_xy, r_yz, r_zx = spin_rotation(w_xy, w_yz, w_zx, o_xx, o_yy, o_zz, o_xy, o_yz, o_zx)
        rotate_state(law, w_xy, w_yz, w_zx, state, i)
        n_xx, n_yy, n_zz, n_xy, n_yz, n_zx, plastic = stress_update(
            law, d_xx, d_yy, d_zz, d_xy, d_yz, d_zx, r_xx, r_yy, r_zz, r_xy, r_yz, r_zx,
            rho, arrays.energy[i], dt, state, i,
        )  # fmt: skip
        viscosity = 0.0
        if volumetric < 0.0:
            closing = -volumetric / dt * arrays.h[i]
            viscosity = rho * closing * (q[0] + q[1] * closing)
        work = 0.5 * ((o_xx + n_xx) * d_xx + (o_yy + n_yy) * d_yy + (o_zz + n_zz) * d_zz)
        work += (o_xy + n_xy) * d_xy + (o_yz + n_yz) * d_yz + (o_zx + n_zx) * d_zx
        specific = 2.0 / (rho + density[i])
        heat = -0.5 * (arrays.viscosity[i] + viscosity) * volumetric  # the mean over the step, as of the stress
        arrays.viscosity[i] = viscosity
        arrays.energy[i] += (work + heat) * specific
        arrays.dissipated[i] += (plastic + heat) * specific
        density[i] = rho
        stress[0, i] = n_xx
        stress[1, i] = n_yy
        stress[2, i] = n_zz
        stress[3, i] = n_xy
        inverse = 1.0 if numbers.mixed else 1.0 / (rho * rho)
        s[0, i] = (n_xx - viscosity) * inverse
        s[1, i] = (n_yy - viscosity) * inverse
        if z is not None:
            stress[4, i] = n_yz
            stress[5, i] = n_zx
            s[2, i] = (n_zz - viscosity) * inverse
            s[3, i] = n_xy * inverse
            s[4, i] = n_yz * inverse
            s[5, i] = n_zx * inverse
        else:
            s[2, i] = n_xy * inverse


@kernel
def kick_and_drift(i0, i1, z, cx, kick, dt, arrays):
    """v += a kick, x += v dt; directions in the mask `fixed` (bits x y z) do not move.

    Returns the largest squared distance from where the list was built, and the index of a particle that moved further
    than its smoothing length or whose velocity is not a number (-1: none).
    """
    x, y, u, v = arrays.x, arrays.y, arrays.u, arrays.v
    largest = 0.0
    bad = np.int64(-1)
    for i in range(i0, i1):
        fixed = arrays.fixed[i]
        if fixed & 1:
            arrays.ax[i] = 0.0
            u[i] = 0.0
        if fixed & 2:
            arrays.ay[i] = 0.0
            v[i] = 0.0
        u[i] += arrays.ax[i] * kick
        v[i] += arrays.ay[i] * kick
        x[i] += u[i] * dt
        y[i] += v[i] * dt
        arrays.x_half[i] = x[i] - 0.5 * dt * u[i]
        arrays.y_half[i] = y[i] - 0.5 * dt * v[i]
        speed2 = u[i] * u[i] + v[i] * v[i]
        moved2 = (x[i] - arrays.x_list[i]) ** 2 + (y[i] - arrays.y_list[i]) ** 2
        if z is not None:
            if fixed & 4:
                arrays.az[i] = 0.0
                arrays.w[i] = 0.0
            arrays.w[i] += arrays.az[i] * kick
            z[i] += arrays.w[i] * dt
            arrays.z_half[i] = z[i] - 0.5 * dt * arrays.w[i]
            speed2 += arrays.w[i] * arrays.w[i]
            moved2 += (z[i] - arrays.z_list[i]) ** 2
        if cx is not None:
            power = cx[i] * u[i] + arrays.cy[i] * v[i]
            if z is not None:
                power += arrays.cz[i] * arrays.w[i]
            arrays.contact_work[i] += 0.5 * dt * arrays.mass[i] * power
        if not speed2 * dt * dt <= arrays.h[i] * arrays.h[i]:
            bad = i
        largest = max(largest, moved2)
    return largest, float(bad)


@kernel
def critical_step(i0, i1, z, numbers, arrays):
    """The smallest stable step of a block by the deck's option.

    1 h/(c+|v|), 2 nearest distance/(c+|v|), 0 by viscosity.
    """
    option = numbers.step_option
    viscous = numbers.viscous
    least = np.inf
    for i in range(i0, i1):
        c = numbers.wave[arrays.material[i]]
        speed2 = arrays.u[i] ** 2 + arrays.v[i] ** 2
        if z is not None:
            speed2 += arrays.w[i] ** 2
        if option == 0:
            length = (arrays.mass[i] / arrays.density[i]) ** (1.0 / numbers.dimension)
            trace = arrays.gradient[0, i]
            if z is not None:
                trace += arrays.gradient[4, i] + arrays.gradient[8, i]
            else:
                trace += arrays.gradient[3, i]
            m = arrays.material[i]
            closing = max(0.0, -trace)
            q = viscous[m, 0] + viscous[m, 1] * length * closing
            least = min(least, length / (q + np.sqrt(q * q + c * c)))
            if numbers.original:
                continue
            c = 0.0  # nor may a particle run past its neighbours
        length = arrays.h[i]
        if option == 2:
            length = np.sqrt(arrays.nearest[i])
            length = min(length, 2.0 * arrays.h[i])
        least = min(least, length / (c + np.sqrt(speed2)))
    return least


@kernel
def force(i0, i1, z, h, mass, nearest, line, cx, potential, mixed, dt, arrays, numbers):
    """Accelerations of a range of particles; returns their critical step."""
    if mixed is not None:
        weight = arrays.volume
        density = arrays.density
        scale = numbers.scale
    else:
        weight = mass
        density = None
        scale = numbers.force_scale
    pairs.momentum(
        i0, i1, arrays.first, arrays.count, arrays.rows, arrays.x, arrays.y, z, arrays.s, weight, h,
        numbers.inverse_h2, scale, line, numbers.body_x, numbers.body_y, numbers.body_z,
        arrays.ax, arrays.ay, arrays.az, nearest, density,
    )  # fmt: skip
    if potential is not None:
        pairs.contact_acceleration(
            i0, i1, arrays.c_first, arrays.c_count, arrays.c_rows, arrays.x, arrays.y, z, arrays.mass, arrays.h,
            -(numbers.dimension + 2.0), numbers.normal, arrays.material, numbers.strength, numbers.exponent,
            numbers.original, arrays.ax, arrays.ay, arrays.az, cx, arrays.cy, arrays.cz,
        )  # fmt: skip
        for i in range(i0, i1):
            power = cx[i] * arrays.u[i] + arrays.cy[i] * arrays.v[i]
            if z is not None:
                power += arrays.cz[i] * arrays.w[i]
            arrays.contact_work[i] += 0.5 * dt * arrays.mass[i] * power
    return critical_step(i0, i1, z, numbers, arrays)


def _each_law(laws, number, i0, i1, z, dt, arrays, numbers):
    """`constitutive` for every body's law; a tuple of different types is unrolled by recursion."""
    raise NotImplementedError("called from jitted code only")


@overload(_each_law, jit_options=JIT_OPTIONS)
def _unrolled(laws, number, i0, i1, z, dt, arrays, numbers):
    if len(laws) == 0:
        return lambda laws, number, i0, i1, z, dt, arrays, numbers: None

    def each(laws, number, i0, i1, z, dt, arrays, numbers):
        constitutive(i0, i1, z, number, laws[0], dt, arrays, numbers)
        _each_law(laws[1:], number + 1, i0, i1, z, dt, arrays, numbers)

    return each


@kernel
def advance(
    thread, threads, sync, n, solid, z, h, mass, nearest, line, cx, potential, mixed, arrays, numbers, laws, progress,
    until, pause, steps, reach2,
):  # fmt: skip
    """Take up to `steps` steps towards `until`, each thread for its own range; returns why it stopped.

    Every thread decides alike, from the same numbers. reach2: squared half skin of the list. Times are met exactly,
    except where the original program is followed: there `until` is a label, the time of the step to come (see
    `solver`). pause: a time that is only to be passed.
    """
    i0, i1 = share(n, thread, threads)
    chunk = n if threads == 1 else CHUNK
    chunks = (n + chunk - 1) // chunk
    taken = 0
    time = progress[TIME]
    last = progress[LAST]
    dt = progress[NEXT]
    first = progress[FIRST]
    done = 0
    pending = progress[PENDING] > 0.0
    reason = PAUSED
    barrier(sync, threads)  # all have read what the first will write
    while True:
        if pending:
            if last > 0.0:
                c = claim(sync, taken)
                while c < chunks:
                    pairs.velocity_gradient(
                        c * chunk, min(n, (c + 1) * chunk), arrays.first, arrays.count, arrays.rows, arrays.x_half,
                        arrays.y_half, solid, arrays.z_half, arrays.u, arrays.v, arrays.w, arrays.volume, h,
                        numbers.inverse_h2, numbers.scale, line, arrays.gradient,
                    )  # fmt: skip
                    c = claim(sync, taken)
                taken += chunks + threads
                barrier(sync, threads)  # the strain of all particles needs the old volumes
                _each_law(laws, 0, i0, i1, z, last, arrays, numbers)
                for i in range(i0, i1):
                    arrays.volume[i] = arrays.mass[i] / arrays.density[i]
                barrier(sync, threads)
            least = np.inf
            c = claim(sync, taken)
            while c < chunks:
                part = force(
                    c * chunk, min(n, (c + 1) * chunk), z, h, mass, nearest, line, cx, potential, mixed, last,
                    arrays, numbers,
                )  # fmt: skip
                least = min(least, part)
                c = claim(sync, taken)
            taken += chunks + threads
            arrays.reduced[thread, 2] = least
            barrier(sync, threads)
            dt = numbers.step_factor * arrays.reduced[:threads, 2].min()
            if last > 0.0:
                dt = min(dt, GROWTH * last)
            pending = False
        if done == steps or (done > 0 and time >= pause):
            break
        left = until - time
        if numbers.original:
            left -= dt
        if left <= 0.0:
            reason = REACHED
            break
        if not dt > COLLAPSE * first:
            reason = COLLAPSED
            break
        now = dt
        landed = False
        if not numbers.original:
            whole = np.ceil(left / dt * (1.0 - 1e-9))
            if whole <= LANDING:
                now = left / whole
                landed = whole == 1
        moved, bad = kick_and_drift(i0, i1, z, cx, 0.5 * (last + now), now, arrays)
        arrays.reduced[thread, 0] = moved
        arrays.reduced[thread, 1] = bad
        barrier(sync, threads)
        moved = arrays.reduced[:threads, 0].max()
        bad = arrays.reduced[:threads, 1].max()
        time = until if landed else time + now
        last = now
        done += 1
        pending = True
        if bad >= 0.0:
            reason = BROKEN
            break
        if moved > reach2:
            reason = REBUILD
            break
    if thread == 0:
        progress[TIME] = time
        progress[LAST] = last
        progress[NEXT] = dt
        progress[STEPS] += done
        progress[PENDING] = 1.0 if pending else 0.0
        if reason == BROKEN:
            progress[BAD] = bad
    return reason
