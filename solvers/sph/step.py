"""One time step: the order of its phases.

Leap-frog: positions and stresses live at whole steps, velocities at half steps. The invariant between steps,
"synchronised": positions, stresses and accelerations at t, velocities at t - dt_last/2. A step then is
    v += a (dt_last + dt)/2, x += dt v                                     kick and drift, to t + dt
    grad v at x - dt v/2, density, rotation, stress, viscosity, energy     strain
    a, nearest distance, contact, the next dt                              force
`prepare` does the last two once at the start. The original program numbers the same states differently; see `solver`.
What a scene does not have is None in `advance`'s arguments and is not compiled at all. Bodies of the total-Lagrangian
formulation (reference) have loops of their own for strain and force; plain: whether there are others. rows_apart: None,
or True where s has all its components: with the gradient correction, and of bodies of revolution (hoop, see rings).
"""

from __future__ import annotations

import numpy as np

from ..jit import kernel
from ..threads import barrier, claim, share
from . import across, bearing, cures, driving, facing, ghosts, lagrangian, nominal, pairs, rest, rings, slip, walls
from .critical import critical_step
from .momentum import momentum
from .packed import pack_forces, pack_motion, pack_smoothing
from .particle import INSTANT, drift, each_law, half_work, kick

# entries of `progress`, the loop's own memory
TIME, LAST, NEXT, STEPS, PENDING, FIRST, BAD = range(7)
PROGRESS = 7

# why `advance` came back
REACHED, PAUSED, REBUILD, BROKEN, COLLAPSED, FAILED = range(6)

CHUNK = 128  # particles that a thread takes on at a time

LANDING = 8  # so many steps before a wanted time the step is trimmed to meet it
GROWTH = 1.1  # a step grows by no more than this
TOWARDS = 0.5  # of its distance from the axis a particle may go in a critical step
COLLAPSE = 1e-7  # a step this small beside the first one will not recover


@kernel
def strain(
    i0, i1, offset, source, shape, near, solid, h, line, correction, density_rate, stress_rate, plain, hoop, reference,
    dt, arrays, numbers,
):  # fmt: skip
    """Velocity gradients of a range of particles, and the rates of diffusion, all with the old densities.

    near: (2, .) the thread's own buffers, see `gather`.
    """
    if plain is not None:
        pairs.velocity_gradient(
            i0, i1, arrays.first, arrays.count, arrays.rows, shape, arrays.packed, near[0], solid, h,
            numbers.inverse_h2, numbers.scale, line, arrays.gradient, correction,
            numbers.corrected, arrays.material,
        )  # fmt: skip
    if hoop is not None:
        rings.radial_strain(i0, i1, arrays)
    if reference is not None and dt > 0.0:
        lagrangian.deformation(i0, i1, solid, dt, reference, arrays)
    if density_rate is not None:
        cures.density_diffusion(
            i0, i1, offset, source, solid, shape, arrays.x_half, arrays.y_half, arrays.z_half, arrays, numbers,
            density_rate,
        )  # fmt: skip
    if stress_rate is not None:
        cures.stress_diffusion(
            i0, i1, offset, source, solid, shape, arrays.x_half, arrays.y_half, arrays.z_half, arrays, numbers,
            stress_rate,
        )  # fmt: skip


@kernel
def force(
    i0, i1, shape, near, z, h, mass, nearest, line, cx, contact, mixed, correction, bx, artificial, heat, body_work,
    wave, friction, damping, normals, by_normals, planes, wall_slip, contact_heat, plain, hoop, rows_apart, reference,
    driven, faces, face_slip, resting, dt, arrays, numbers,
):  # fmt: skip
    """Accelerations of a range of particles; returns their critical step."""
    if mixed is not None:
        weight = arrays.volume
        density = arrays.density
        scale = numbers.scale
    else:
        weight = mass
        density = None
        scale = numbers.force_scale
    body = numbers.body
    if hoop is not None:
        body = rings.NO_FORCE
    if plain is not None:
        momentum(
            i0, i1, arrays.first, arrays.count, arrays.rows, shape, arrays.packed, arrays.beside, near[0], near[1], z,
            weight, h, numbers.inverse_h2, scale, line, body, arrays.ax, arrays.ay, arrays.az, nearest, density,
            rows_apart, artificial, numbers.inverse_w, bx, arrays.by, arrays.bz,
        )  # fmt: skip
    if hoop is not None:
        rings.hoop_force(i0, i1, numbers.body, arrays)
    longest = np.inf
    if reference is not None:
        longest = lagrangian.internal_force(i0, i1, z, plain, reference, arrays, numbers)
    if heat is not None:
        cures.pair_viscosity(i0, i1, z, shape, arrays, numbers, heat)
    least = np.inf
    if contact is not None:
        least = across.contact_force(
            i0, i1, z, shape, contact, friction, damping, normals, by_normals, dt, cx, contact_heat, arrays, numbers
        )
    if planes is not None:
        least = min(
            least, walls.wall_force(i0, i1, z, planes, contact, damping, wall_slip, contact_heat, dt, cx, arrays)
        )
    if faces is not None:
        if planes is not None:
            held = facing.face_force(
                i0, i1, z, faces, planes, damping, face_slip, contact_heat, resting, dt, cx, arrays
            )
        else:
            held = facing.face_force(
                i0, i1, z, faces, contact, damping, face_slip, contact_heat, resting, dt, cx, arrays
            )
        least = min(least, held)
        facing.add_impulse(i0, i1, 0.5 * dt, faces)
    if driven is not None:
        if contact is not None:
            driving.thrust_by_contact(i0, i1, z, cx, arrays)
        elif mixed is not None:
            power = -(numbers.dimension + 2.0)
            driving.thrust_by_kernel(i0, i1, z, shape, arrays.volume, power, rows_apart, arrays, numbers)
        else:
            power = -(numbers.dimension + 2.0)
            driving.thrust_by_kernel(i0, i1, z, shape, arrays.mass, power, rows_apart, arrays, numbers)
        driving.add_impulse(i0, i1, 0.5 * dt, arrays)
    half_work(i0, i1, z, cx, bx, body_work, dt, arrays, numbers)
    if numbers.original:
        least = np.inf
    if hoop is not None:
        least = min(least, rings.closest(i0, i1, TOWARDS, arrays))
    return min(longest, least, critical_step(i0, i1, z, wave, correction, numbers, arrays))


@kernel
def body_force_at(time, numbers):
    """Sets numbers.body by the table of the base acceleration, constant beyond its ends."""
    times = numbers.body_times
    k = min(max(np.searchsorted(times, time, side="right"), 1), len(times) - 1)
    part = min(max((time - times[k - 1]) / (times[k] - times[k - 1]), 0.0), 1.0)
    for axis in range(3):
        before = numbers.body_values[k - 1, axis]
        numbers.body[axis] = before + part * (numbers.body_values[k, axis] - before)


@kernel
def advance(
    thread, threads, sync, n, offset, shape, solid, z, h, mass, nearest, line, cx, contact, mixed, correction, bx,
    artificial, h_list, h_start, density_rate, stress_rate, heat, smoothed, smoothing, body_work, wave,
    walled, image_source, image_sign, image_shift, mirrors, friction, damping, normals, by_normals, planes, wall_slip,
    contact_heat, plain, hoop, rows_apart, reference, driven, faces, face_slip, resting, arrays, numbers, laws,
    progress, until, pause, due, steps, reach2,
):  # fmt: skip
    """Take up to `steps` steps towards `until`, each thread for its own range; returns why it stopped.

    Every thread decides alike, from the same numbers. reach2: squared half skin of the list. Times are met exactly,
    except where the original program is followed: there `until` is a label, the time of the step to come (see
    `solver`). pause: a time that is only to be passed. due: a time from which on the lists are
    wanted anew. resting: None, or `rest.Resting`.
    """
    i0, i1 = share(n, thread, threads)
    near = arrays.near[thread]
    chunk = n if threads == 1 else CHUNK
    chunks = (n + chunk - 1) // chunk
    time = progress[TIME]
    last = progress[LAST]
    dt = progress[NEXT]
    first = progress[FIRST]
    done = 0
    pending = progress[PENDING] > 0.0
    reason = PAUSED
    fresh = pending
    if resting is not None:  # the lists may be new, and the facets have set out
        rest.settle(i0, i1, n, cx, resting, image_source, offset, faces, fresh, arrays)
    barrier(sync, threads)  # all have read what the first will write
    while True:
        if pending:
            if last > 0.0 or correction is not None:  # whose first forces need the matrix
                if image_source is not None:
                    g0, g1 = share(len(image_source), thread, threads)
                    ghosts.follow_motion(g0, g1, offset, z, image_source, image_sign, image_shift, arrays)
                    barrier(sync, threads)
                if hoop is not None:
                    rings.flow(i0, i1, hoop, arrays)
                    g0, g1 = share(len(image_source), thread, threads)
                    rings.flow(offset + g0, offset + g1, hoop, arrays)
                    barrier(sync, threads)
                pack_motion(thread, threads, sync, 0, solid, h, hoop, plain, arrays)
                c = claim(sync, thread, threads, chunks)
                while c < chunks:
                    end = min(n, (c + 1) * chunk)
                    a, b = rest.run_of(c * chunk, end, resting, rest.HELD, arrays.still)
                    while a < b:
                        strain(
                            a, b, offset, image_source, shape, near, solid, h, line, correction, density_rate,
                            stress_rate, plain, hoop, reference, last, arrays, numbers,
                        )  # fmt: skip
                        if walled is not None and driven is not None:
                            bearing.without_walls(a, b, solid, shape, correction, arrays, numbers)
                        if resting is not None:
                            rest.no_diffusion(a, b, density_rate, stress_rate, arrays)
                        a, b = rest.run_of(b, end, resting, rest.HELD, arrays.still)
                    c = claim(sync, thread, threads, chunks)
                barrier(sync, threads)  # the strain of all particles needs the old volumes
            # at the very start without strain: what an equation of state makes of the first densities
            a, b = rest.run_of(i0, i1, resting, rest.HELD, arrays.still)
            while a < b:
                each_law(
                    laws, 0, a, b, z, max(last, INSTANT), correction, density_rate, stress_rate, heat, wave, hoop,
                    arrays, numbers,
                )  # fmt: skip
                a, b = rest.run_of(b, i1, resting, rest.HELD, arrays.still)
            if reference is not None:
                arrays.reduced[thread, 3] = nominal.nominal_stress(i0, i1, z, reference, arrays)
            if hoop is not None:
                rings.areas(i0, i1, arrays)
            else:
                for i in range(i0, i1):
                    arrays.volume[i] = arrays.mass[i] / arrays.density[i]
            barrier(sync, threads)
            if reference is not None:
                bad = arrays.reduced[:threads, 3].max()
                if bad >= 0.0:
                    reason = FAILED
                    break
            if image_source is not None:
                g0, g1 = share(len(image_source), thread, threads)
                ghosts.follow_stress(g0, g1, offset, z, rows_apart, image_source, image_sign, arrays)
                if reference is not None:
                    nominal.follow(g0, g1, offset, z, image_source, image_sign, arrays)
                barrier(sync, threads)
            if walled is not None:
                bearing.bear(i0, i1, z, shape, correction, last, arrays, numbers)
                barrier(sync, threads)
            if walled is not None and image_source is not None:
                g0, g1 = share(len(image_source), thread, threads)
                ghosts.follow_stress(g0, g1, offset, z, rows_apart, image_source, image_sign, arrays)
                barrier(sync, threads)
            if body_work is not None and thread == 0:
                body_force_at(time, numbers)
            if body_work is not None:
                barrier(sync, threads)
            if normals is not None:
                slip.phase(
                    thread, threads, sync, n, offset, z, shape, contact, friction, damping, last, image_source,
                    image_sign, arrays, numbers,
                )  # fmt: skip
            pack_forces(thread, threads, sync, 0, z, h, mass, mixed, rows_apart, plain, arrays)
            least = np.inf
            look = False
            if resting is not None:
                look = (int(progress[STEPS]) + done) % rest.LOOK == 0
            most = rest.DEEP if look else rest.HELD
            c = claim(sync, thread, threads, chunks)
            while c < chunks:
                end = min(n, (c + 1) * chunk)
                at = c * chunk
                a, b = rest.run_of(at, end, resting, most, arrays.still)
                while a < b:
                    if resting is not None:  # the deep are to wake into a stable step
                        least = min(least, critical_step(at, a, z, wave, correction, numbers, arrays))
                        if faces is not None:  # and weigh on what they lie on
                            facing.add_impulse(at, a, 0.5 * last, faces)
                        at = b
                    part = force(
                        a, b, shape, near, z, h, mass, nearest, line, cx, contact, mixed, correction, bx, artificial,
                        heat, body_work, wave, friction, damping, normals, by_normals, planes, wall_slip, contact_heat,
                        plain, hoop, rows_apart, reference, driven, faces, face_slip, resting, last, arrays, numbers,
                    )  # fmt: skip
                    least = min(least, part)
                    a, b = rest.run_of(b, end, resting, most, arrays.still)
                if resting is not None:
                    least = min(least, critical_step(at, end, z, wave, correction, numbers, arrays))
                    if faces is not None:
                        facing.add_impulse(at, end, 0.5 * last, faces)
                c = claim(sync, thread, threads, chunks)
            arrays.reduced[thread, 2] = least
            barrier(sync, threads)
            dt = numbers.step_factor * arrays.reduced[:threads, 2].min()
            if last > 0.0:
                dt = min(dt, GROWTH * last)
            if resting is not None:
                arrays.reduced[thread, 5] = rest.wake(
                    i0, i1, n, z, cx, resting, image_source, offset, driven, faces, look, last, arrays
                )
                barrier(sync, threads)
                woken = arrays.reduced[:threads, 5].max() > 0.0
                if look and time >= numbers.body_times[-1]:  # gravity is what it will be
                    rest.fall_asleep(i0, i1, n, z, cx, resting, image_source, offset, last, arrays)
                    barrier(sync, threads)
                if look or woken or fresh:
                    rest.settle(i0, i1, n, cx, resting, image_source, offset, faces, False, arrays)
                fresh = False
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
        a, b = rest.run_of(i0, i1, resting, rest.AWAKE, arrays.still)
        while a < b:
            kick(a, b, z, cx, bx, body_work, 0.5 * (last + now), now, arrays, numbers)
            a, b = rest.run_of(b, i1, resting, rest.AWAKE, arrays.still)
        if resting is not None:
            rest.count_quiet(i0, i1, z, resting, faces, now, arrays)
        if driven is not None:
            driving.add_impulse(i0, i1, 0.5 * now, arrays)
        if faces is not None:
            facing.add_impulse(i0, i1, 0.5 * now, faces)
            facing.move(thread, threads, now, faces)
            if thread == 0:
                faces.motion[1] += faces.motion[0] * now
        if smoothed is not None:
            barrier(sync, threads)
            if image_source is not None:
                g0, g1 = share(len(image_source), thread, threads)
                ghosts.follow_motion(g0, g1, offset, z, image_source, image_sign, image_shift, arrays)
                barrier(sync, threads)
            pack_smoothing(thread, threads, sync, solid, h, arrays)
            c = claim(sync, thread, threads, chunks)
            while c < chunks:
                cures.smoothed_velocity(
                    c * chunk, min(n, (c + 1) * chunk), arrays.first, arrays.count, arrays.rows, shape, arrays.packed,
                    near[0], solid, h, mass, numbers.inverse_h2, 2.0 * smoothing * numbers.force_scale, line, smoothed,
                )  # fmt: skip
                c = claim(sync, thread, threads, chunks)
            barrier(sync, threads)
        moved = 0.0
        bad = -1.0
        a, b = rest.run_of(i0, i1, resting, rest.AWAKE, arrays.still)
        while a < b:
            far, lost = drift(a, b, z, smoothed, h_start, h_list, mirrors, 0.5 * shape.support, now, arrays, numbers)
            moved = max(moved, far)
            bad = max(bad, lost)
            a, b = rest.run_of(b, i1, resting, rest.AWAKE, arrays.still)
        arrays.reduced[thread, 0] = moved
        arrays.reduced[thread, 1] = bad
        barrier(sync, threads)
        moved = arrays.reduced[:threads, 0].max()
        if faces is not None:
            moved = (np.sqrt(moved) + faces.motion[1]) ** 2
        bad = arrays.reduced[:threads, 1].max()
        time = until if landed else time + now
        last = now
        done += 1
        pending = True
        if bad >= 0.0:
            reason = BROKEN
            break
        if moved > reach2 or time >= due:
            reason = REBUILD
            break
    if thread == 0:
        progress[TIME] = time
        progress[LAST] = last
        progress[NEXT] = dt
        progress[STEPS] += done
        progress[PENDING] = 1.0 if pending else 0.0
        if reason in (BROKEN, FAILED):
            progress[BAD] = bad
    return reason
