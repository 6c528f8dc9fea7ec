"""The stress of the law becomes that of the reference configuration; terms as in `lagrangian`."""

from __future__ import annotations

import numpy as np

from ..jit import kernel
from ..materials import PLASTIC_STRAIN

# rows of `hourglass`: psi [volume], its change in the last step, kappa [pressure], largest equivalent stress, and the
# length of artificial viscosity, zero of particles that are not total-Lagrangian: h, but no more than FLATTENED times
# the distance to the nearest neighbour. Over the h of the start the viscosity of a flattened body limits the step.
PSI, CHANGE, KAPPA, BORNE, LENGTH = range(5)
HOURGLASS = 5

FLATTENED = 1.2  # whatever the deck's option: no step longer than this times nearest distance / wave speed
CRUSHED = 0.01  # det F below this, or
STRETCHED = 50.0  # |F| above this: the body does not stay whole
# The hourglass stress of a particle that has flowed, in the greatest stress that it has borne. At 0.05 the modes of a
# shell that implodes (samples/verney_shell) grew until particles met; at 0.1, 0.2, 0.5 it comes to rest at 49.80,
# 49.96, 50.12 mm (exact 50.00).
YIELDING = 0.2


@kernel
def _equivalent(stress, z, i):
    """Von Mises' equivalent stress."""
    xx = stress[0, i]
    yy = stress[1, i]
    zz = stress[2, i]
    shear = stress[3, i] ** 2
    if z is not None:
        shear += stress[4, i] ** 2 + stress[5, i] ** 2
    return np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * shear)


@kernel
def follow(g0, g1, n, z, source, sign, arrays):
    """The images' `nominal` and kappa, of the images g0..g1 that stand at n + g: a mirror changes signs."""
    nominal = arrays.nominal
    for g in range(g0, g1):
        i = source[g]
        j = n + g
        xy = sign[0, g] * sign[1, g]
        arrays.hourglass[KAPPA, j] = arrays.hourglass[KAPPA, i]
        nominal[0, j] = nominal[0, i]
        if z is not None:
            yz = sign[1, g] * sign[2, g]
            zx = sign[2, g] * sign[0, g]
            nominal[1, j] = xy * nominal[1, i]
            nominal[2, j] = zx * nominal[2, i]
            nominal[3, j] = xy * nominal[3, i]
            nominal[4, j] = nominal[4, i]
            nominal[5, j] = yz * nominal[5, i]
            nominal[6, j] = zx * nominal[6, i]
            nominal[7, j] = yz * nominal[7, i]
            nominal[8, j] = nominal[8, i]
        else:
            nominal[1, j] = xy * nominal[1, i]
            nominal[2, j] = xy * nominal[2, i]
            nominal[3, j] = nominal[3, i]


@kernel
def nominal_stress(i0, i1, z, reference, arrays):
    """After the law: density, V P M^-1 - kappa (F - I)/2 into `nominal`, and the work on the hourglass modes.

    Where the material has flowed its resistance is not its modulus any more: kappa then is so small that the hourglass
    stress stays below a share of the greatest equivalent stress that the particle has borne. Returns a particle that
    is crushed, turned inside out or stretched beyond measure, or -1.
    """
    f = arrays.deformation
    stress = arrays.stress
    nominal = arrays.nominal
    inverse = reference.inverse
    hourglass = arrays.hourglass
    bad = np.int64(-1)
    for i in range(i0, i1):
        if reference.count[i] == 0:
            continue
        m = arrays.material[i]
        kappa = reference.stiffness[m]
        if arrays.state.shape[0] > 0:
            borne = max(hourglass[BORNE, i], _equivalent(stress, z, i))
            hourglass[BORNE, i] = borne
            if arrays.state[PLASTIC_STRAIN, i] > 0.0:
                trace = reference.trace[i]
                strain = np.sqrt(max(0.0, 4.0 * hourglass[PSI, i] / trace))
                kappa = min(kappa, YIELDING * borne / (strain + 1e-300))
        arrays.artificial_work[i] -= 0.5 * (hourglass[KAPPA, i] + kappa) * hourglass[CHANGE, i]
        hourglass[KAPPA, i] = kappa
        half = 0.5 * kappa
        v = reference.volume[i]
        q = arrays.viscosity[i]
        xx = v * (stress[0, i] - q)
        yy = v * (stress[1, i] - q)
        xy = v * stress[3, i]
        if z is not None:
            zz = v * (stress[2, i] - q)
            yz = v * stress[4, i]
            zx = v * stress[5, i]
            fxx = 1.0 + f[0, i]
            fxy = f[1, i]
            fxz = f[2, i]
            fyx = f[3, i]
            fyy = 1.0 + f[4, i]
            fyz = f[5, i]
            fzx = f[6, i]
            fzy = f[7, i]
            fzz = 1.0 + f[8, i]
            cxx = fyy * fzz - fyz * fzy
            cxy = fyz * fzx - fyx * fzz
            cxz = fyx * fzy - fyy * fzx
            cyx = fxz * fzy - fxy * fzz
            cyy = fxx * fzz - fxz * fzx
            cyz = fxy * fzx - fxx * fzy
            czx = fxy * fyz - fxz * fyy
            czy = fxz * fyx - fxx * fyz
            czz = fxx * fyy - fxy * fyx
            volume = fxx * cxx + fxy * cxy + fxz * cxz
            norm2 = fxx * fxx + fxy * fxy + fxz * fxz + fyx * fyx + fyy * fyy + fyz * fyz
            norm2 += fzx * fzx + fzy * fzy + fzz * fzz
            bxx = inverse[0, i]
            byy = inverse[1, i]
            bzz = inverse[2, i]
            bxy = inverse[3, i]
            byz = inverse[4, i]
            bzx = inverse[5, i]
            px = xx * cxx + xy * cyx + zx * czx
            py = xx * cxy + xy * cyy + zx * czy
            pz = xx * cxz + xy * cyz + zx * czz
            nominal[0, i] = px * bxx + py * bxy + pz * bzx - half * f[0, i]
            nominal[1, i] = px * bxy + py * byy + pz * byz - half * f[1, i]
            nominal[2, i] = px * bzx + py * byz + pz * bzz - half * f[2, i]
            px = xy * cxx + yy * cyx + yz * czx
            py = xy * cxy + yy * cyy + yz * czy
            pz = xy * cxz + yy * cyz + yz * czz
            nominal[3, i] = px * bxx + py * bxy + pz * bzx - half * f[3, i]
            nominal[4, i] = px * bxy + py * byy + pz * byz - half * f[4, i]
            nominal[5, i] = px * bzx + py * byz + pz * bzz - half * f[5, i]
            px = zx * cxx + yz * cyx + zz * czx
            py = zx * cxy + yz * cyy + zz * czy
            pz = zx * cxz + yz * cyz + zz * czz
            nominal[6, i] = px * bxx + py * bxy + pz * bzx - half * f[6, i]
            nominal[7, i] = px * bxy + py * byy + pz * byz - half * f[7, i]
            nominal[8, i] = px * bzx + py * byz + pz * bzz - half * f[8, i]
        else:
            fxx = 1.0 + f[0, i]
            fxy = f[1, i]
            fyx = f[2, i]
            fyy = 1.0 + f[3, i]
            volume = fxx * fyy - fxy * fyx
            norm2 = fxx * fxx + fxy * fxy + fyx * fyx + fyy * fyy
            bxx = inverse[0, i]
            byy = inverse[1, i]
            bxy = inverse[2, i]
            px = xx * fyy - xy * fxy
            py = xy * fxx - xx * fyx
            nominal[0, i] = px * bxx + py * bxy - half * f[0, i]
            nominal[1, i] = px * bxy + py * byy - half * f[1, i]
            px = xy * fyy - yy * fxy
            py = yy * fxx - xy * fyx
            nominal[2, i] = px * bxx + py * bxy - half * f[2, i]
            nominal[3, i] = px * bxy + py * byy - half * f[3, i]
        arrays.density[i] = reference.density[i] / volume
        if not (volume > CRUSHED and norm2 < STRETCHED * STRETCHED):
            bad = i
    return float(bad)
