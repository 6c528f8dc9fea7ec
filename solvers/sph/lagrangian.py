"""Pair loops of bodies that stay whole: the total-Lagrangian formulation, with hourglass control.

All sums run over the neighbours of the reference configuration X with G_ij = V_i V_j grad_i W(X_ij) = c_ij X_ij:
    F_i = (sum_j (x_j - x_i) (x) G_ij) M_i^-1,  M_i = sum_j (X_j - X_i) (x) G_ij          exact for linear fields
    P = (sigma - q I) cof F                                                                first Piola-Kirchhoff
    f_i = sum_j (V_i P_i M_i^-1 + V_j P_j M_j^-1) G_ij                                     antisymmetric in i and j
As P F' is symmetric, the sum of x_i x f_i vanishes too. F is the fit of the positions with weights -c_ij, so that
    psi_i = 1/4 sum_j -c_ij |F_i X_ij - x_ij|^2
is what no F can describe: the hourglass modes (Ganzenmueller 2015). kappa_i psi_i is taken as their energy. Because F
minimises it, its force is that at constant F, sum_j -c_ij/2 (kappa_i (F_i X_ij - x_ij) + kappa_j (F_j X_ij - x_ij)):
pairwise, without moment, zero for affine fields, and as X_ij c_ij = G_ij the parts of F ride on the stress. The loops
have displacements x - X and their gradient F - I in place of x and F: a body at rest stays there to the last bit.

Shapes: as in `pairs`; the reference list, its weights c (single precision: only their symmetry matters, the rest is
exact for any c) and the inverse shape matrices stand in `reference.Reference`.
"""

from __future__ import annotations

import numpy as np

from ..bits import bits_of, of_bits
from ..jit import kernel
from .momentum import ALONE
from .nominal import CHANGE, FLATTENED, KAPPA, LENGTH, PSI


@kernel
def deformation(i0, i1, solid, dt, reference, arrays):
    """F - I at the positions now, and with the old one the velocity gradient of the step between.

    L = (F - F_old)/dt ((F + F_old)/2)^-1: its strain is none in a rotation, and its spin turns by the very angle.
    """
    x, y = arrays.x, arrays.y
    x_start, y_start = arrays.x_start, arrays.y_start
    if solid is not None:
        z = arrays.z
        z_start = arrays.z_start
    rows, weight, inverse = reference.rows, reference.weight, reference.inverse
    f = arrays.deformation
    gradient = arrays.gradient
    for i in range(i0, i1):
        if reference.count[i] == 0:
            continue
        xs = x_start[i]
        ys = y_start[i]
        xi = x[i] - xs
        yi = y[i] - ys
        axx = 0.0
        axy = 0.0
        ayx = 0.0
        ayy = 0.0
        spread = 0.0
        if solid is not None:
            zs = z_start[i]
            zi = z[i] - zs
            axz = 0.0
            ayz = 0.0
            azx = 0.0
            azy = 0.0
            azz = 0.0
        begin = np.uint64(reference.first[i])
        for k in range(np.uint64(reference.count[i])):
            j = rows[begin + k]
            c = np.float64(weight[begin + k])
            xj = x_start[j]
            yj = y_start[j]
            gx = c * (xs - xj)
            gy = c * (ys - yj)
            dx = (x[j] - xj) - xi
            dy = (y[j] - yj) - yi
            r2 = dx * dx + dy * dy
            axx += dx * gx
            axy += dx * gy
            ayx += dy * gx
            ayy += dy * gy
            if solid is not None:
                zj = z_start[j]
                gz = c * (zs - zj)
                dz = (z[j] - zj) - zi
                r2 += dz * dz
                axz += dx * gz
                ayz += dy * gz
                azx += dz * gx
                azy += dz * gy
                azz += dz * gz
            spread -= c * r2
        if solid is not None:
            bxx = inverse[0, i]
            byy = inverse[1, i]
            bzz = inverse[2, i]
            bxy = inverse[3, i]
            byz = inverse[4, i]
            bzx = inverse[5, i]
            fxx = axx * bxx + axy * bxy + axz * bzx
            fxy = axx * bxy + axy * byy + axz * byz
            fxz = axx * bzx + axy * byz + axz * bzz
            fyx = ayx * bxx + ayy * bxy + ayz * bzx
            fyy = ayx * bxy + ayy * byy + ayz * byz
            fyz = ayx * bzx + ayy * byz + ayz * bzz
            fzx = azx * bxx + azy * bxy + azz * bzx
            fzy = azx * bxy + azy * byy + azz * byz
            fzz = azx * bzx + azy * byz + azz * bzz
            spread -= axx * fxx + axy * fxy + axz * fxz + ayx * fyx + ayy * fyy + ayz * fyz
            spread -= azx * fzx + azy * fzy + azz * fzz
            mxx = 1.0 + 0.5 * (fxx + f[0, i])
            mxy = 0.5 * (fxy + f[1, i])
            mxz = 0.5 * (fxz + f[2, i])
            myx = 0.5 * (fyx + f[3, i])
            myy = 1.0 + 0.5 * (fyy + f[4, i])
            myz = 0.5 * (fyz + f[5, i])
            mzx = 0.5 * (fzx + f[6, i])
            mzy = 0.5 * (fzy + f[7, i])
            mzz = 1.0 + 0.5 * (fzz + f[8, i])
            cxx = myy * mzz - myz * mzy
            cxy = myz * mzx - myx * mzz
            cxz = myx * mzy - myy * mzx
            rate = 1.0 / (dt * (mxx * cxx + mxy * cxy + mxz * cxz))
            cxx *= rate
            cxy *= rate
            cxz *= rate
            cyx = (mxz * mzy - mxy * mzz) * rate
            cyy = (mxx * mzz - mxz * mzx) * rate
            cyz = (mxy * mzx - mxx * mzy) * rate
            czx = (mxy * myz - mxz * myy) * rate
            czy = (mxz * myx - mxx * myz) * rate
            czz = (mxx * myy - mxy * myx) * rate
            dxx = fxx - f[0, i]
            dxy = fxy - f[1, i]
            dxz = fxz - f[2, i]
            gradient[0, i] = dxx * cxx + dxy * cxy + dxz * cxz
            gradient[1, i] = dxx * cyx + dxy * cyy + dxz * cyz
            gradient[2, i] = dxx * czx + dxy * czy + dxz * czz
            dxx = fyx - f[3, i]
            dxy = fyy - f[4, i]
            dxz = fyz - f[5, i]
            gradient[3, i] = dxx * cxx + dxy * cxy + dxz * cxz
            gradient[4, i] = dxx * cyx + dxy * cyy + dxz * cyz
            gradient[5, i] = dxx * czx + dxy * czy + dxz * czz
            dxx = fzx - f[6, i]
            dxy = fzy - f[7, i]
            dxz = fzz - f[8, i]
            gradient[6, i] = dxx * cxx + dxy * cxy + dxz * cxz
            gradient[7, i] = dxx * cyx + dxy * cyy + dxz * cyz
            gradient[8, i] = dxx * czx + dxy * czy + dxz * czz
            f[0, i] = fxx
            f[1, i] = fxy
            f[2, i] = fxz
            f[3, i] = fyx
            f[4, i] = fyy
            f[5, i] = fyz
            f[6, i] = fzx
            f[7, i] = fzy
            f[8, i] = fzz
        else:
            bxx = inverse[0, i]
            byy = inverse[1, i]
            bxy = inverse[2, i]
            fxx = axx * bxx + axy * bxy
            fxy = axx * bxy + axy * byy
            fyx = ayx * bxx + ayy * bxy
            fyy = ayx * bxy + ayy * byy
            spread -= axx * fxx + axy * fxy + ayx * fyx + ayy * fyy
            mxx = 1.0 + 0.5 * (fxx + f[0, i])
            mxy = 0.5 * (fxy + f[1, i])
            myx = 0.5 * (fyx + f[2, i])
            myy = 1.0 + 0.5 * (fyy + f[3, i])
            rate = 1.0 / (dt * (mxx * myy - mxy * myx))
            dxx = (fxx - f[0, i]) * rate
            dxy = (fxy - f[1, i]) * rate
            dyx = (fyx - f[2, i]) * rate
            dyy = (fyy - f[3, i]) * rate
            gradient[0, i] = dxx * myy - dxy * myx
            gradient[1, i] = dxy * mxx - dxx * mxy
            gradient[2, i] = dyx * myy - dyy * myx
            gradient[3, i] = dyy * mxx - dyx * mxy
            f[0, i] = fxx
            f[1, i] = fxy
            f[2, i] = fyx
            f[3, i] = fyy
        arrays.hourglass[CHANGE, i] = 0.25 * spread - arrays.hourglass[PSI, i]
        arrays.hourglass[PSI, i] = 0.25 * spread


@kernel
def internal_force(i0, i1, z, plain, reference, arrays, numbers):
    """Accelerations by stress and hourglass control, and squared distances to the nearest neighbour.

    plain: None where no other loop has set the accelerations. Returns the longest step that flattened particles allow.
    """
    x, y = arrays.x, arrays.y
    x_start, y_start = arrays.x_start, arrays.y_start
    rows, weight = reference.rows, reference.weight
    kappa = arrays.hourglass[KAPPA]
    sxx = arrays.nominal[0]
    sxy = arrays.nominal[1]
    if z is not None:
        z_start = arrays.z_start
        sxz = arrays.nominal[2]
        syx = arrays.nominal[3]
        syy = arrays.nominal[4]
        syz = arrays.nominal[5]
        szx = arrays.nominal[6]
        szy = arrays.nominal[7]
        szz = arrays.nominal[8]
    else:
        syx = arrays.nominal[2]
        syy = arrays.nominal[3]
    longest = np.inf
    for i in range(i0, i1):
        if plain is None:
            arrays.ax[i] = numbers.body[0]
            arrays.ay[i] = numbers.body[1]
            if z is not None:
                arrays.az[i] = numbers.body[2]
            arrays.nearest[i] = of_bits(ALONE)
        if reference.count[i] == 0:
            continue
        xi = x[i]
        yi = y[i]
        xs = x_start[i]
        ys = y_start[i]
        sum_gx = 0.0
        sum_gy = 0.0
        fx = 0.0
        fy = 0.0
        if z is not None:
            zi = z[i]
            zs = z_start[i]
            sum_gz = 0.0
            fz = 0.0
        half = 0.5 * kappa[i]
        least = ALONE
        begin = np.uint64(reference.first[i])
        for k in range(np.uint64(reference.count[i])):
            j = rows[begin + k]
            c = np.float64(weight[begin + k])
            rx = xs - x_start[j]
            ry = ys - y_start[j]
            gx = c * rx
            gy = c * ry
            dx = xi - x[j]
            dy = yi - y[j]
            r2 = dx * dx + dy * dy
            spring = c * (half + 0.5 * kappa[j])
            sum_gx += gx
            sum_gy += gy
            if z is not None:
                rz = zs - z_start[j]
                gz = c * rz
                dz = zi - z[j]
                r2 += dz * dz
                sum_gz += gz
                fx += sxx[j] * gx + sxy[j] * gy + sxz[j] * gz + spring * (dx - rx)
                fy += syx[j] * gx + syy[j] * gy + syz[j] * gz + spring * (dy - ry)
                fz += szx[j] * gx + szy[j] * gy + szz[j] * gz + spring * (dz - rz)
            else:
                fx += sxx[j] * gx + sxy[j] * gy + spring * (dx - rx)
                fy += syx[j] * gx + syy[j] * gy + spring * (dy - ry)
            least = min(least, bits_of(r2))
        inverse = 1.0 / arrays.mass[i]
        if z is not None:
            fx += sxx[i] * sum_gx + sxy[i] * sum_gy + sxz[i] * sum_gz
            fy += syx[i] * sum_gx + syy[i] * sum_gy + syz[i] * sum_gz
            fz += szx[i] * sum_gx + szy[i] * sum_gy + szz[i] * sum_gz
            arrays.az[i] += fz * inverse
        else:
            fx += sxx[i] * sum_gx + sxy[i] * sum_gy
            fy += syx[i] * sum_gx + syy[i] * sum_gy
        arrays.ax[i] += fx * inverse
        arrays.ay[i] += fy * inverse
        distance2 = of_bits(least)
        arrays.nearest[i] = distance2
        length = FLATTENED * np.sqrt(distance2)
        arrays.hourglass[LENGTH, i] = min(length, arrays.h[i])
        longest = min(longest, length / numbers.wave[arrays.material[i]])
    return longest
