# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Voxels that all differ, axes, and combinations of properties."""
import gzip
import itertools
import os

import numpy as np

TYPES = "u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f4", "f8"
ORDERS = "<", ">"
SHAPE = (3, 4, 5)       # [k, j, i]
LARGER = (10, 11, 12)   # with more bytes of voxels than a header has
ORIGIN = np.array([10.0, -20.0, 30.0])
SPACING = np.array([0.5, 1.25, 2.0])
FIRST_TIME, TIME_STEP = 3.0, 0.5

_ROTATION = np.array([[2.0, -2.0, 1.0], [1.0, 2.0, 2.0], [-2.0, -1.0, 2.0]]) / 3.0
# The steps from voxel to voxel along i, j and k are the columns, in LPS.
AXES = {
    "identity": np.diag(SPACING),
    "mirrored": np.diag(SPACING * (-1, 1, 1)),
    "turned": np.diag(SPACING * (-1, -1, 1)),
    "permuted": np.array([[0.0, 1.25, 0.0], [0.0, 0.0, 2.0], [0.5, 0.0, 0.0]]),
    "oblique": _ROTATION @ np.diag(SPACING),
    "oblique mirrored": _ROTATION @ np.diag(SPACING * (1, 1, -1)),
    "sheared": np.diag(SPACING) + [[0.0, 0.0, 0.4], [0.0, 0.0, -0.2], [0.0, 0.0, 0.0]],
}
NOT_SHEARED = {name: steps for name, steps in AXES.items() if name != "sheared"}
RAS_TO_LPS = np.diag([-1.0, -1.0, 1.0])


def voxels(dtype="i2", frames=None, shape=SHAPE):
    """Mixed, with the least and the greatest value of the type."""
    shape = shape if frames is None else (frames, *shape)
    count = int(np.prod(shape))
    dtype = np.dtype(dtype)
    if dtype.kind in "iu":
        least, greatest = int(np.iinfo(dtype).min), int(np.iinfo(dtype).max)
        values = [least + (greatest - least) * n // (count - 1) for n in range(count)]
    else:
        limits = np.finfo(dtype)
        values = [limits.min, limits.max, limits.tiny, 0.1, *(n - 7.25 for n in range(count - 4))]
    mixed = np.random.default_rng(3).permutation(count)
    return np.array(values, dtype)[mixed].reshape(shape)


def affine(steps=AXES["identity"], origin=ORIGIN):
    return np.column_stack([steps, origin])


def times(frames, first=FIRST_TIME, step=TIME_STEP):
    return tuple(first + step * n for n in range(frames))


def raw(array, order="<"):
    return array.astype(array.dtype.newbyteorder(order)).tobytes()


def gzipped(data):
    return gzip.compress(data, mtime=0)  # the same bytes at any time


def text(array, separator=" "):
    """The numbers with all their digits."""
    values = (int(v) if array.dtype.kind in "iu" else float(v) for v in array.ravel())
    return separator.join(map(repr, values)).encode() + b"\n"


def combinations(**factors):
    """Combinations of properties in which each two values of two properties occur together.

    With VOXPLEX_MATRIX_STRENGTH=3 in the environment it is each three of three, and so on.
    """
    strength = int(os.environ.get("VOXPLEX_MATRIX_STRENGTH", "2"))
    names, values = list(factors), [list(f) for f in factors.values()]
    missing = set()
    for chosen in itertools.combinations(range(len(names)), min(strength, len(names))):
        missing.update(itertools.product(*(_choices(factor, values) for factor in chosen)))
    cases = []
    for first in sorted(missing):
        if first not in missing:
            continue
        case = dict(first)
        for factor in (n for n in range(len(names)) if n not in case):
            others = list(itertools.combinations(case.items(), len(first) - 1))
            def found(choice, others=others):
                return sum(tuple(sorted((choice, *other))) in missing for other in others)
            choices = _choices(factor, values)
            turn = len(cases) % len(choices)  # mixes what is as good
            case[factor] = max(choices[turn:] + choices[:turn], key=found)[1]
        missing.difference_update(itertools.combinations(sorted(case.items()), len(first)))
        cases.append({name: values[n][case[n]] for n, name in enumerate(names)})
    return cases


def _choices(factor, values):
    return [(factor, index) for index in range(len(values[factor]))]


def title(combination):
    return ", ".join(str(value) for value in combination.values())
