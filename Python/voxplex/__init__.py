# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Voxplex: label images to conforming simplex meshes.

    import voxplex

    mesh = voxplex.mesh("knee.nrrd", delta=1.5, label_sizes={3: 1.0})
    mesh.write("knee.vtu")

:func:`mesh` turns a segmented image (an array, a file, an image of VTK, PyVista, ITK, SimpleITK or nibabel) into a :class:`Mesh` of
tetrahedra, and a time series into one of pentatopes: NumPy arrays, which VTK, PyVista and meshio take as they are.
:func:`quality` measures a mesh.

For pipelines there are `vtkImageToTetMeshFilter` and `vtkImageToPentatopeMeshFilter`. Where Voxplex was built with
VTK's Python wrapping, these are the C++ classes, and there are `vtkPentatopeMeshTimeSlice`, `vtkSimplexMeshInterfaces`,
`vtkSimplexMeshQuality`, `vtkSegmentationReader`, `vtkMasksToSegmentation` and `vtkSimplexMeshWriter`; in the wheel they are made for any VTK (:mod:`voxplex.pipeline`).

`python3 -m voxplex` runs the command line.
"""

import importlib.util
from typing import Any, List

if importlib.util.find_spec("numpy") is None:
    raise ModuleNotFoundError("voxplex needs NumPy, which this Python does not find: pip install numpy", name="numpy")

from .errors import ArgumentError, FileError, MeshingCancelled, MeshingError, MeshingWarning
from .files import read_segmentation
from .images import Image
from .installation import VERSION as __version__
from .measuring import quality
from .meshes import Interfaces, Mesh
from .meshing import mesh

__all__ = ["ArgumentError", "FileError", "Image", "Interfaces", "Mesh", "MeshingCancelled", "MeshingError",
           "MeshingWarning", "__version__", "mesh", "quality", "read_segmentation"]

_CLASSES = ("vtkVoxplex", "vtkVoxplexIO", "pipeline")  # modules; the first two are wrapped, and not in the wheel


def __dir__() -> List[str]:
    return [*__all__, "vtkImageToPentatopeMeshFilter", "vtkImageToTetMeshFilter"]


def __getattr__(name: str) -> Any:
    """The VTK classes. VTK is loaded with the first of them, not with the package."""
    if name.startswith("vtk"):
        for module in _CLASSES:
            try:
                found = importlib.import_module("." + module, __name__)
            except ImportError as missing:
                if missing.name == "vtkmodules":
                    raise AttributeError(f"{name}: {missing}") from missing
                if not isinstance(missing, ModuleNotFoundError) or missing.name != f"{__name__}.{module}":
                    raise
                continue
            if hasattr(found, name):
                return getattr(found, name)
        raise AttributeError(f"there is no {name} in this package; it has all VTK classes where it was built with VTK's "
                             "Python wrapping, which the wheel was not")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
