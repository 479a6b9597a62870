"""Colours of black bodies: Planck's law seen by the CIE 1931 observer, of luminance 1."""

from __future__ import annotations

from typing import Any

import numpy

STEFAN = 5.670374e-8
"""Of the law of Stefan and Boltzmann [W/(m² K⁴)]."""

_TO_REC709 = numpy.array([[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560],
                          [0.0556434, -0.2040259, 1.0572252]])


def _bump(x: Any, middle: float, below: float, above: float) -> Any:
    return numpy.exp(-0.5 * ((x - middle) / numpy.where(x < middle, below, above)) ** 2)


def color_of(kelvin: Any) -> Any:
    """Linear Rec.709 (..., 3) of luminance 1; the observer by the fit of Wyman, Sloan and Shirley (2013)."""
    nm = numpy.arange(380.0, 781.0, 5.0)
    observer = numpy.stack([
        1.056 * _bump(nm, 599.8, 37.9, 31.0) + 0.362 * _bump(nm, 442.0, 16.0, 26.7) - 0.065 * _bump(nm, 501.1, 20.4, 26.2),
        0.821 * _bump(nm, 568.8, 46.9, 40.5) + 0.286 * _bump(nm, 530.9, 16.3, 31.1),
        1.217 * _bump(nm, 437.0, 11.8, 36.0) + 0.681 * _bump(nm, 459.0, 26.0, 13.8),
    ])
    heat = numpy.maximum(numpy.asarray(kelvin, float), 100.0)[..., None]
    metres = nm * 1e-9
    light = metres**-5 / numpy.expm1(numpy.minimum(1.438777e-2 / (metres * heat), 600))
    xyz = light @ observer.T
    return numpy.maximum((xyz / xyz[..., 1:2]) @ _TO_REC709.T, 0)
