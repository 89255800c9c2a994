# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""`image.voxplex.mesh(delta=1.5)` for the images of PyVista, which finds this by the wheel's entry point."""

from __future__ import annotations

from typing import Any

import pyvista

from .meshing import mesh


@pyvista.register_dataset_accessor("voxplex", pyvista.ImageData)
class VoxplexAccessor:
    """Of a label image, or one of grey values with isovalue."""

    def __init__(self, image: Any) -> None:
        self._image = image

    def mesh(self, delta: Any = None, **arguments: Any) -> Any:
        """A pyvista.UnstructuredGrid; voxplex.mesh() has the arguments."""
        return mesh(self._image, delta, **arguments).to_pyvista()
