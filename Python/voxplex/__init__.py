# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Voxplex: label images to conforming simplex meshes.

    import voxplex

    mesh = voxplex.mesh(voxplex.example(), delta=1.5, label_sizes={"Meniscus": 1.0})
    mesh.write("knee.vtu")

:func:`mesh` turns a segmented image (an array, a file, an image of VTK, PyVista, ITK, SimpleITK or nibabel) into a :class:`Mesh` of
tetrahedra, and a time series into one of pentatopes: NumPy arrays, which VTK, PyVista and meshio take as they are.
:func:`quality` measures a mesh.

Where Voxplex was built with VTK's Python wrapping, its VTK classes are here, too: `vtkImageToTetMeshFilter`,
`vtkImageToPentatopeMeshFilter`, `vtkPentatopeMeshTimeSlice`, `vtkSimplexMeshInterfaces`, `vtkSimplexMeshQuality`,
`vtkSegmentationReader`, `vtkMasksToSegmentation` and `vtkSimplexMeshWriter`. The wheel has none of them.

`python3 -m voxplex` runs the command line.
"""

import importlib.util
from typing import Any

if importlib.util.find_spec("numpy") is None:
    raise ModuleNotFoundError("voxplex needs NumPy, which this Python does not find: pip install numpy", name="numpy")

from .errors import ArgumentError, FileError, MeshingCancelled, MeshingError, MeshingWarning
from .examples import example
from .images import Image
from .installation import VERSION as __version__
from .measuring import quality
from .meshes import Interfaces, Mesh, read_mesh
from .meshing import mesh, repair
from .sources import read_segmentation

__all__ = ["ArgumentError", "FileError", "Image", "Interfaces", "Mesh", "MeshingCancelled", "MeshingError",
           "MeshingWarning", "__version__", "example", "mesh", "quality", "read_mesh", "read_segmentation", "repair"]


def __getattr__(name: str) -> Any:
    """The VTK classes. VTK is loaded with the first of them, not with the package."""
    if name.startswith("vtk"):
        for module in ("vtkVoxplex", "vtkVoxplexIO"):
            if importlib.util.find_spec(f"{__name__}.{module}") is not None:
                found = getattr(importlib.import_module("." + module, __name__), name, None)
                if found is not None:
                    return found
        raise AttributeError(f"there is no {name} in this package; VTK classes are there where it was built with VTK's Python wrapping, "
                             "which the wheel was not: take voxplex.mesh() and what it returns")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
