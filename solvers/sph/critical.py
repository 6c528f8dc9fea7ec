"""The largest stable step: of waves, of artificial viscosity, of the gradient correction and of a fluid's viscosity."""

from __future__ import annotations

import numpy as np

from ..jit import kernel
from .particle import DRIVEN, INSTANT

OWN_FREQUENCY = 2.3  # largest frequency of corrected particles by what each strains itself: 1.2 to 2.15 found
DIFFUSION = 0.125  # of h^2 / nu: what viscosity may spread in a step (Morris, Fox & Zhu 1997)


@kernel
def corrected_step(i, z, c, correction, numbers, arrays):
    """The largest stable step of a particle whose gradients are corrected.

    At a free surface a particle strains itself by moving, and B takes that twice: its frequency is up to
    `OWN_FREQUENCY` times c |B sum V grad W|, and what the artificial viscosity damps of it is its share, with which a
    step of the leap-frog must be smaller (Belytschko, Liu & Moran 2000, 6.2.2).
    """
    frequency = OWN_FREQUENCY * c * np.sqrt(correction[6 if z is not None else 3, i])
    trace = arrays.gradient[0, i]
    if z is not None:
        trace += arrays.gradient[4, i] + arrays.gradient[8, i]
    else:
        trace += arrays.gradient[3, i]
    viscous = numbers.viscous
    m = arrays.material[i]
    length = arrays.h[i]
    damping = 0.5 * frequency * length / c * (viscous[m, 0] + viscous[m, 1] * length * max(0.0, -trace) / c)
    return 2.0 * (np.sqrt(1.0 + damping * damping) - damping) / (frequency + INSTANT)


@kernel
def critical_step(i0, i1, z, wave, correction, numbers, arrays):
    """The smallest stable step of a block by the deck's option.

    1 h/(c+|v|), 2 nearest distance/(c+|v|), 0 by artificial viscosity; and by a fluid's own viscosity. What does not
    move limits nothing, unless its own law's stress pushes softer neighbours of another body.
    """
    option = numbers.step_option
    viscous = numbers.viscous
    all_fixed = (1 << numbers.dimension) - 1
    least = np.inf
    for i in range(i0, i1):
        held = (arrays.fixed[i] & all_fixed) == all_fixed
        limits = numbers.held_limits and (numbers.original or not arrays.fixed[i] & DRIVEN)
        if held and (not limits or numbers.wall[arrays.material[i]] > 0.0):
            continue
        c = numbers.wave[arrays.material[i]]
        if wave is not None and c > 0.0:
            c = wave[i]
        if arrays.interface.shape[0] > 0:
            c = max(c, arrays.interface[0, i])
        speed2 = arrays.u[i] ** 2 + arrays.v[i] ** 2
        if z is not None:
            speed2 += arrays.w[i] ** 2
        if correction is not None and c > 0.0:
            least = min(least, corrected_step(i, z, c, correction, numbers, arrays))
        if option == 0:
            length = arrays.volume[i] ** (1.0 / numbers.dimension)
            trace = arrays.gradient[0, i]
            if z is not None:
                trace += arrays.gradient[4, i] + arrays.gradient[8, i]
            else:
                trace += arrays.gradient[3, i]
            m = arrays.material[i]
            closing = max(0.0, -trace)
            q = viscous[m, 0] * c + viscous[m, 1] * length * closing
            least = min(least, length / (q + np.sqrt(q * q + c * c)))
            if numbers.original:
                continue
            c = 0.0  # nor may a particle run past its neighbours
        length = arrays.h[i]
        if option == 2:
            length = np.sqrt(arrays.nearest[i])
            length = min(max(length, numbers.least_distance * arrays.h[i]), 2.0 * arrays.h[i])
        least = min(least, length / (c + np.sqrt(speed2)))
        viscosity = numbers.kinematic_viscosity[arrays.material[i]]
        if viscosity > 0.0:
            least = min(least, DIFFUSION * arrays.h[i] * arrays.h[i] / viscosity)
    return least
