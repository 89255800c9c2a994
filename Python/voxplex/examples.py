# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""An image to begin with."""

from __future__ import annotations

from typing import Any, Sequence

import numpy

from .images import Image

_TISSUES = {"Femur": (0.89, 0.85, 0.79), "Tibia": (0.85, 0.80, 0.70), "Fibula": (0.80, 0.74, 0.62), "Patella": (0.93, 0.90, 0.85),
            "Cartilage": (0.44, 0.69, 0.84), "Meniscus": (0.72, 0.33, 0.30)}


def example() -> Image:
    """A stylised left knee of six tissues, made of ellipsoids and cylinders: it is nobody's, and free for any use.

    Returns
    -------
    Image
        Of 60 x 56 x 80 voxels of 1.5 mm, in LPS, with names and colours of labels.

    Examples
    --------
    >>> import voxplex
    >>> voxplex.example().names
    {1: 'Femur', 2: 'Tibia', 3: 'Fibula', 4: 'Patella', 5: 'Cartilage', 6: 'Meniscus'}
    """
    shape, spacing, origin = (80, 56, 60), 1.5, (-44.25, -45.0, -59.25)
    z, y, x = (start + spacing * place for start, place in zip(reversed(origin), numpy.indices(shape)))

    def inside(centre: Sequence[float], radii: Sequence[float]) -> Any:
        return sum(((place - middle) / radius) ** 2 for place, middle, radius in zip((x, y, z), centre, radii)) < 1

    labels = numpy.zeros(shape, dtype=numpy.uint8)
    for side in (-19, 19):
        labels[((numpy.hypot(x - side, y - 2) - 13) / 7) ** 2 + ((z + 3) / 4.5) ** 2 < 1] = 6
    labels[((x / 38) ** 2 + ((y - 3) / 26) ** 2 < 1) & (abs(z + 10.5) < 3.5)] = 5
    for side in (-19, 19):
        labels[inside((side, 3, 19), (21, 28, 22)) & (z < 26)] = 5
    for side in (-19, 19):
        labels[inside((side, 3, 19), (17, 24, 18))] = 1
    labels[(numpy.hypot(x, y - 3) < 12 + 0.004 * (z - 55) ** 2) & (z > 12)] = 1
    labels[((x / 36) ** 2 + ((y - 3) / 24) ** 2 < (1 - numpy.clip(-14 - z, 0, 18) / 30) ** 2) & (z < -14)] = 2
    labels[(numpy.hypot(x - 35, y - 24) < 6.5) & (z < -20) & (labels == 0)] = 3
    labels[inside((0, -35, 24), (17, 8, 18))] = 4
    result = Image(labels, spacing=(spacing,) * 3, origin=origin, space="LPS", names=dict(enumerate(_TISSUES, 1)))
    result.colors = dict(enumerate(_TISSUES.values(), 1))
    return result
