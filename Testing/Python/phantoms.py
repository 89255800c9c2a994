# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Images that the tests mesh."""

import numpy


def ball(n=24, radii=(8.0,), centre=None):
    """n x n x n voxels, indexed [k, j, i]: label 1 in the ball of the first radius, 2 in that of the next."""
    centre = (0.5 * (n - 1),) * 3 if centre is None else centre
    k, j, i = numpy.mgrid[:n, :n, :n]
    distance = numpy.sqrt((i - centre[0]) ** 2 + (j - centre[1]) ** 2 + (k - centre[2]) ** 2)
    result = numpy.zeros((n, n, n), dtype=numpy.uint8)
    for label, radius in enumerate(radii, 1):
        result[distance < radius] = label
    return result


def brick():
    """20 x 16 x 12 voxels (i, j, k): a brick of label 5 with one of label 9 at larger i."""
    result = numpy.zeros((12, 16, 20), dtype=numpy.int16)
    result[3:9, 4:12, 4:10] = 5
    result[3:9, 4:12, 10:16] = 9
    return result


def beating(frames=4, n=12):
    """[t, k, j, i]: a ball that grows from frame to frame."""
    return numpy.stack([ball(n, (3.0 + 0.5 * frame,)) for frame in range(frames)])
