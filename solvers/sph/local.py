"""Local time steps: stiff bodies go several small steps within one of the others.

Bodies that repel each other (`contact`) fall into two classes, the slow ones in front of the stiff ones in every array.
At the beginning of an outer step of length H the forces F between bodies and of walls are found once. Inside it the
slow bodies take one step, the stiff ones as many as they need, with their own neighbours only, which are all of their
own body. The slow ones are kicked as ever, F_n (H' + H)/2 with the H' before. The stiff ones have all through the step
    G_n = F_n + (F_n - F_n-1) H'/(2 H)
which is F in the middle of the step, extrapolated; what they have been given then lags behind the slow ones' by
(F_n - F_n-1) H'/2, never more, and pair by pair: with that in the velocities (`velocity`), momentum is conserved to
the last digits. The same F as one impulse at the beginning (Tuckerman, Berne & Martyna 1992) makes the surface of a
steel plate ring, and its viscosity takes that energy, which the contact has made: 39 % of a soft block's kinetic
energy where this makes 0.01 %. The phases and the invariant between steps are those of `step`; u of a stiff body stands
half an inner step before.

Kernel contact cannot be split like this: the force on a particle of sand beside steel has the steel's stress in it,
and is as stiff as the steel.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..jit import kernel
from ..threads import barrier, claim, share
from . import across, packed, slip, step, walls
from .nominal import nominal_stress
from .particle import INSTANT, drift, each_law, half_work, kick
from .problem import Problem
from .state import Floats

RATIO = 4.0  # of two bodies' steps, from which on it is worth while by itself
LEAST_RATIO = 1.5  # and where it is asked for

# entries of `inner`: the last and next step of the stiff bodies, and how many they took
FAST_LAST, FAST_NEXT, FAST_STEPS = range(3)
INNER = 3


def classes(p: Problem, wave: Floats, *, xsph: bool) -> NDArray[np.bool_] | None:
    """(bodies,) which are stiff; None where all bodies take the same steps.

    wave: (bodies,) speeds, zero of rigid ones, which never count. xsph: whether particles move with the mean velocity.
    ValueError where local steps are asked for and cannot be.
    """
    if p.local_steps is False:
        return None
    hindered = _hindrance(p, xsph=xsph)
    if hindered is not None and p.local_steps:
        raise ValueError(f"local time steps do not go together with {hindered}")
    stiff, ratio = _widest_gap(p, wave)
    if hindered is not None or ratio < (LEAST_RATIO if p.local_steps else RATIO):
        return None
    return stiff


def _hindrance(p: Problem, *, xsph: bool) -> str | None:
    hindered = {
        "kernel contact between bodies (the potential or pinballs do)": not p.apart,
        "boundary planes": bool(p.planes),
        "the arithmetic of the original program": p.original,
        "a changing h": p.h_option != 0,
        "dynamic relaxation": p.relaxation != 1.0,
        "base acceleration by curve": p.body_curve is not None,
        "XSPH": xsph,
        "births": p.birth is not None,
        "sleep": p.sleep > 0.0,
        "walls that bear their neighbours' stress": any(b.bearing for b in p.bodies),
        "a structure": p.driven is not None or p.facets is not None,
    }
    return next((name for name, there in hindered.items() if there), None)


def _widest_gap(p: Problem, wave: Floats) -> tuple[NDArray[np.bool_], float]:
    """(bodies,) which lie below the widest gap between steps, and by how much those beyond it are longer; 1 without."""
    steps = body_steps(p, wave)
    moving = np.sort(steps[np.isfinite(steps)])
    if len(moving) < 2:
        return np.zeros(len(steps), bool), 1.0
    ratios = moving[1:] / moving[:-1]
    k = int(np.argmax(ratios))
    return np.asarray(steps <= moving[k]), float(ratios[k])


def advice(p: Problem, wave: Floats, *, xsph: bool) -> str:
    """For the log: who makes the step of all where local steps would be worth while and cannot be; else nothing."""
    hindered = _hindrance(p, xsph=xsph)
    stiff, ratio = _widest_gap(p, wave)
    if p.local_steps is not None or p.original or hindered is None or ratio < RATIO:
        return ""
    names = ", ".join(b.name for b, is_stiff in zip(p.bodies, stiff, strict=True) if is_stiff)
    return f", all in the steps of {names}, {ratio:.0f} times what others need: no local steps with {hindered}"


def body_steps(p: Problem, wave: Floats) -> Floats:
    """(bodies,) how long a wave takes through the smallest particle of each; infinite of rigid and empty ones."""
    length = (p.mass / p.density) ** (1.0 / p.dimension) if p.step_option == 2 else p.h
    least = np.full(len(p.bodies), np.inf)
    np.minimum.at(least, p.body, length)
    with np.errstate(divide="ignore"):
        return np.where(wave > 0.0, least / wave, np.inf)


def in_front(order: NDArray[np.int64], stiff: NDArray[np.bool_]) -> NDArray[np.int64]:
    """The same order with the particles of slow bodies in front. stiff: by particle, in the old order."""
    return np.concatenate((order[~stiff[order]], order[stiff[order]]))


def velocity(u: Floats, a: Floats, c: Floats, held: Floats, last: float, inner: Floats) -> Floats:
    """(d, m) velocities of the stiff bodies at the time of the positions, with what the contact still owes them.

    u: half an inner step before; a: accelerations by the body itself, c: by others; held: (2 d, m) G and F of the step
    before; last: the outer step.
    """
    given, before = np.split(held, 2)
    return u + 0.5 * float(inner[FAST_LAST]) * (a + given) + 0.5 * last * (c - before)


@kernel
def _hold(i0, i1, z, part, arrays):
    """G and F of the outer step that begins. part: H'/(2 H)."""
    held = arrays.held
    d = 3 if z is not None else 2
    for i in range(i0, i1):
        held[0, i] = arrays.cx[i] + (arrays.cx[i] - held[d, i]) * part
        held[1, i] = arrays.cy[i] + (arrays.cy[i] - held[d + 1, i]) * part
        held[d, i] = arrays.cx[i]
        held[d + 1, i] = arrays.cy[i]
        if z is not None:
            held[2, i] = arrays.cz[i] + (arrays.cz[i] - held[5, i]) * part
            held[5, i] = arrays.cz[i]


@kernel
def _push(i0, i1, z, duration, arrays):
    """v += G duration."""
    for i in range(i0, i1):
        arrays.u[i] += arrays.held[0, i] * duration
        arrays.v[i] += arrays.held[1, i] * duration
        if z is not None:
            arrays.w[i] += arrays.held[2, i] * duration


@kernel
def _push_work(i0, i1, z, dt, arrays):
    """Work of G over half a step."""
    for i in range(i0, i1):
        power = arrays.held[0, i] * arrays.u[i] + arrays.held[1, i] * arrays.v[i]
        if z is not None:
            power += arrays.held[2, i] * arrays.w[i]
        arrays.contact_work[i] += 0.5 * dt * arrays.mass[i] * power


@kernel
def _reach_in_time(i0, i1, z, arrays):
    """The shortest time in which a particle goes a smoothing length."""
    least = np.inf
    for i in range(i0, i1):
        speed2 = arrays.u[i] ** 2 + arrays.v[i] ** 2
        if z is not None:
            speed2 += arrays.w[i] ** 2
        if speed2 > 0.0:
            least = min(least, arrays.h[i] / np.sqrt(speed2))
    return least


@kernel
def _laws(i0, i1, z, laws, correction, density_rate, stress_rate, heat, wave, reference, dt, arrays, numbers):
    """Laws, nominal stress and volumes of a range; returns a particle that has turned inside out, or -1."""
    each_law(
        laws, 0, i0, i1, z, max(dt, INSTANT), correction, density_rate, stress_rate, heat, wave, None, arrays,
        numbers,
    )  # fmt: skip
    torn = -1.0
    if reference is not None:
        torn = nominal_stress(i0, i1, z, reference, arrays)
    for i in range(i0, i1):
        arrays.volume[i] = arrays.mass[i] / arrays.density[i]
    return torn


@kernel
def _meet(
    i0, i1, z, shape, cx, contact, friction, damping, normals, by_normals, planes, wall_slip, contact_heat, dt, arrays,
    numbers,
):  # fmt: skip
    """Forces between bodies and of walls on a range of particles; returns the longest stable step."""
    least = across.contact_force(
        i0, i1, z, shape, contact, friction, damping, normals, by_normals, dt, cx, contact_heat, arrays, numbers
    )
    if planes is not None:
        least = min(
            least, walls.wall_force(i0, i1, z, planes, contact, damping, wall_slip, contact_heat, dt, cx, arrays)
        )
    return least


@kernel
def advance(
    thread, threads, sync, n, split, shape, solid, z, h, mass, nearest, line, cx, contact, correction, bx, artificial,
    density_rate, stress_rate, heat, wave, friction, damping, normals, by_normals, planes, wall_slip, contact_heat,
    plain, reference, arrays, numbers, laws, progress, inner, until, pause, steps, reach2,
):  # fmt: skip
    """As `step.advance`, with the particles from `split` on in inner steps. inner: see FAST_LAST."""
    i0, i1 = share(split, thread, threads)
    j0, j1 = share(n - split, thread, threads)
    j0 += split
    j1 += split
    near = arrays.near[thread]
    chunk = n if threads == 1 else step.CHUNK
    slow_chunks = (split + chunk - 1) // chunk
    fast_chunks = (n - split + chunk - 1) // chunk
    time = progress[step.TIME]
    last = progress[step.LAST]
    dt = progress[step.NEXT]
    first = progress[step.FIRST]
    fast_last = inner[FAST_LAST]
    fast = inner[FAST_NEXT]
    fast_done = 0
    done = 0
    pending = progress[step.PENDING] > 0.0
    reason = step.PAUSED
    bad = -1.0
    begins = True  # the outer step begins: all bodies are at the same time, and meet
    rest = 0.0  # of the outer step
    parts = 1.0  # that it still has
    now = 0.0
    landed = False
    moved = 0.0
    broken = -1.0
    barrier(sync, threads)  # all have read what the first will write
    while True:
        if pending:
            from_chunk = 0 if begins else slow_chunks
            chunks = slow_chunks + fast_chunks
            if last > 0.0 or not begins or correction is not None:  # see step.advance
                packed.pack_motion(thread, threads, sync, 0 if begins else split, solid, h, None, plain, arrays)
                c = from_chunk + claim(sync, thread, threads, chunks - from_chunk)
                while c < chunks:
                    if c < slow_chunks:
                        a = c * chunk
                        b = min(split, a + chunk)
                    else:
                        a = split + (c - slow_chunks) * chunk
                        b = min(n, a + chunk)
                    step.strain(
                        a, b, n, None, shape, near, solid, h, line, correction, density_rate, stress_rate, plain, None,
                        reference, last if c < slow_chunks else fast_last, arrays, numbers,
                    )  # fmt: skip
                    c = from_chunk + claim(sync, thread, threads, chunks - from_chunk)
                barrier(sync, threads)
            torn = _laws(
                j0,
                j1,
                z,
                laws,
                correction,
                density_rate,
                stress_rate,
                heat,
                wave,
                reference,
                fast_last,
                arrays,
                numbers,
            )
            if begins:
                torn = max(torn, _laws(
                    i0, i1, z, laws, correction, density_rate, stress_rate, heat, wave, reference, last, arrays,
                    numbers,
                ))  # fmt: skip
            arrays.reduced[thread, 3] = torn
            barrier(sync, threads)
            bad = arrays.reduced[:threads, 3].max()
            if bad >= 0.0:
                reason = step.FAILED
                break
            if begins and normals is not None:
                slip.phase(
                    thread, threads, sync, n, n, z, shape, contact, friction, damping, last, None, None, arrays, numbers
                )
            packed.pack_forces(
                thread, threads, sync, 0 if begins else split, z, h, mass, None, correction, plain, arrays
            )  # fmt: skip
            slow_least = np.inf
            fast_least = np.inf
            c = from_chunk + claim(sync, thread, threads, chunks - from_chunk)
            while c < chunks:
                if c < slow_chunks:
                    a = c * chunk
                    b = min(split, a + chunk)
                else:
                    a = split + (c - slow_chunks) * chunk
                    b = min(n, a + chunk)
                met = np.inf
                if begins and c >= slow_chunks:  # before its own forces, which set the acceleration anew
                    met = _meet(
                        a, b, z, shape, cx, contact, friction, damping, normals, by_normals, planes, wall_slip,
                        contact_heat, last, arrays, numbers,
                    )  # fmt: skip
                since = last if c < slow_chunks else fast_last
                own = step.force(
                    a, b, shape, near, z, h, mass, nearest, line, None, None, None, correction, bx, artificial, heat,
                    None, wave, None, None, None, None, None, None, None, plain, None, correction, reference,
                    None, None, None, None, since, arrays, numbers,
                )  # fmt: skip
                if c < slow_chunks:
                    met = _meet(
                        a, b, z, shape, cx, contact, friction, damping, normals, by_normals, planes, wall_slip,
                        contact_heat, last, arrays, numbers,
                    )  # fmt: skip
                    half_work(a, b, z, cx, None, None, last, arrays, numbers)
                    slow_least = min(slow_least, own, met)
                else:
                    _push_work(a, b, z, fast_last, arrays)
                    fast_least = min(fast_least, own)
                    slow_least = min(slow_least, met)
                    if begins:  # the lists are to hold for the whole outer step
                        reach = _reach_in_time(a, b, z, arrays)
                        slow_least = min(slow_least, across.CLOSING * reach / numbers.step_factor)
                c = from_chunk + claim(sync, thread, threads, chunks - from_chunk)
            arrays.reduced[thread, 2] = slow_least
            arrays.reduced[thread, 4] = fast_least
            barrier(sync, threads)
            fast = numbers.step_factor * arrays.reduced[:threads, 4].min()
            if begins:
                dt = numbers.step_factor * arrays.reduced[:threads, 2].min()
                if last > 0.0:
                    dt = min(dt, step.GROWTH * last)
                    fast = min(fast, step.GROWTH * fast_last)
            pending = False
        if begins:
            if done == steps or (done > 0 and time >= pause):
                break
            left = until - time
            if left <= 0.0:
                reason = step.REACHED
                break
            if not dt > step.COLLAPSE * first:
                reason = step.COLLAPSED
                break
            now = dt
            landed = False
            whole = np.ceil(left / dt * (1.0 - 1e-9))
            if whole <= step.LANDING:
                now = left / whole
                landed = whole == 1
            rest = now
            kick(i0, i1, z, cx, bx, None, 0.5 * (last + now), now, arrays, numbers)
        if not fast > step.COLLAPSE * first:
            reason = step.COLLAPSED
            break
        wanted = max(1.0, np.ceil(rest / fast * (1.0 - 1e-9)))
        # within an outer step inner ones only become shorter: it is to end on time
        parts = wanted if begins else max(wanted, parts - 1.0)
        small = rest if parts == 1.0 else rest / parts
        _push(j0, j1, z, 0.5 * fast_last, arrays)
        if begins:
            _hold(j0, j1, z, 0.5 * last / now, arrays)
        _push(j0, j1, z, 0.5 * small, arrays)
        kick(j0, j1, z, None, bx, None, 0.5 * (fast_last + small), small, arrays, numbers)
        _push_work(j0, j1, z, small, arrays)
        if begins:
            moved, broken = drift(i0, i1, z, None, None, None, None, 0.5 * shape.support, now, arrays, numbers)
        far, lost = drift(j0, j1, z, None, None, None, None, 0.5 * shape.support, small, arrays, numbers)
        moved = max(moved, far)
        broken = max(broken, lost)
        fast_last = small
        fast_done += 1
        rest -= small
        begins = parts == 1.0
        pending = True
        arrays.reduced[thread, 0] = moved
        arrays.reduced[thread, 1] = broken
        barrier(sync, threads)
        bad = arrays.reduced[:threads, 1].max()
        if begins:
            time = until if landed else time + now
            last = now
            done += 1
            if bad < 0.0 and arrays.reduced[:threads, 0].max() > reach2:
                reason = step.REBUILD
                break
        if bad >= 0.0:
            reason = step.BROKEN
            break
    if thread == 0:
        progress[step.TIME] = time
        progress[step.LAST] = last
        progress[step.NEXT] = dt
        progress[step.STEPS] += done
        progress[step.PENDING] = 1.0 if pending else 0.0
        inner[FAST_LAST] = fast_last
        inner[FAST_NEXT] = fast
        inner[FAST_STEPS] += fast_done
        if reason in (step.BROKEN, step.FAILED):
            progress[step.BAD] = bad
    return reason
