"""Colours of black bodies, of luminance 1, as Cycles has them."""

from __future__ import annotations

from typing import Any

import numpy

STEFAN = 5.670374e-8
"""Of the law of Stefan and Boltzmann [W/(m² K⁴)]."""

_LOWEST, _HIGHEST = 800.0, 12000.0
"""Temperatures [K] beyond which colours stay as they are there."""
_STEPS = (965.0, 1167.0, 1449.0, 1902.0, 3315.0, 6365.0)
"""Where the pieces of the fits below begin, after the first one. Figures are those of Blender's
intern/cycles/kernel/svm/math_util.h (Apache 2.0), whose pictures they have to be like."""
_RED = (
    (1.61919106e3, -2.05010916e-3, 5.02995757), (2.48845471e3, -1.11330907e-3, 3.22621544),
    (3.34143193e3, -4.86551192e-4, 1.76486769), (4.09461742e3, -1.27446582e-4, 7.25731635e-1),
    (4.67028036e3, 2.91258199e-5, 1.26703442e-1), (4.59509185e3, 2.87495649e-5, 1.50345020e-1),
    (3.78717450e3, 9.35907826e-6, 3.99075871e-1),
)
_GREEN = (
    (-4.88999748e2, 6.04330754e-4, -7.55807526e-2), (-7.55994277e2, 3.16730098e-4, 4.78306139e-1),
    (-1.02363977e3, 1.20223470e-4, 9.36662319e-1), (-1.26571316e3, 4.87340896e-6, 1.27054498),
    (-1.42529332e3, -4.01150431e-5, 1.43972784), (-1.17554822e3, -2.16378048e-5, 1.30408023),
    (-5.00799571e2, -4.59832026e-6, 1.09098763),
)
"""Of the inverse of the temperature, the temperature, and 1."""
_BLUE = (
    (5.96945309e-11, -4.85742887e-8, -9.70622247e-5, -4.07936148e-3),
    (2.40430366e-11, 5.55021075e-8, -1.98503712e-4, 2.89312858e-2),
    (-1.40949732e-11, 1.89878968e-7, -3.56632824e-4, 9.10767778e-2),
    (-3.61460868e-11, 2.84822009e-7, -4.93211319e-4, 1.56723440e-1),
    (-1.97075738e-11, 1.75359352e-7, -2.50542825e-4, -2.22783266e-2),
    (-1.61997957e-13, -1.64216008e-8, 3.86216271e-4, -7.38077418e-1),
    (6.72650283e-13, -2.73078809e-8, 4.24098264e-4, -7.52335691e-1),
)
"""Of the third power of the temperature and those below."""


def color_of(kelvin: Any) -> Any:
    """Linear Rec.709 (..., 3)."""
    heat = numpy.clip(numpy.asarray(kelvin, float), _LOWEST, _HIGHEST)
    piece = numpy.searchsorted(_STEPS, heat, side="right")
    by_inverse = numpy.stack([1 / heat, heat, numpy.ones_like(heat)], axis=-1)
    powers = numpy.stack([heat**3, heat**2, heat, numpy.ones_like(heat)], axis=-1)
    parts = [(numpy.array(fit)[piece] * terms).sum(axis=-1)
             for fit, terms in ((_RED, by_inverse), (_GREEN, by_inverse), (_BLUE, powers))]
    return numpy.maximum(numpy.stack(parts, axis=-1), 0)
