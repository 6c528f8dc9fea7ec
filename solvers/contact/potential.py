"""Repulsive contact by a potential of the kernel (Vignjevic et al. 2006; [T] 5.3.7-13; the deck's contact type 1).

a_i = - sum_j m_j (K_i + K_j) f^n grad_i W(r_ij, h_ij), f = W(r)/W(h) of the mean smoothing length h_ij, over particles
j of other bodies. K [pressure/density^2], n [-]: contact strength and exponent; the pair's exponent is the mean of
both, so that action equals reaction.
"""

from __future__ import annotations

from ..jit import kernel


@kernel
def strength_ratio(shape, reference):
    """f of the spline's value at r and at its reference distance; shapes as `spline` (un-normalised)."""
    return shape / reference


@kernel
def original_reference(s):
    """The divisor of f as the original program codes it, at s = h_j/h_ij: without its factor 1/4 from s = 1 on."""
    if s < 1.0:
        return 0.75 * s * s * s - 1.5 * s * s + 1.0
    return (2.0 - s) ** 3
