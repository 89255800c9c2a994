# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Voxplex: label images to conforming simplex meshes.

This wheel has the program: `voxplex` or `python -m voxplex` in a shell. It has none of the functions of the package
that is built with VTK.
"""

from .installation import VERSION as __version__

__all__ = ["__version__"]
