# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Voxplex: label images to conforming simplex meshes.

    import voxplex

    mesh = voxplex.mesh("knee.nrrd", delta=1.5, label_sizes={3: 1.0})
    voxplex.write(mesh, "knee.vtu")

:func:`mesh` turns a segmented image (a vtkImageData, a NumPy array or a file) into a
vtkUnstructuredGrid of tetrahedra, and a time series into one of pentatopes. `points`, `tets`,
`labels` and their siblings show it as NumPy arrays that share its memory. :func:`quality` measures it.

Beside these functions there are the wrapped VTK classes, for pipelines: `vtkImageToTetMeshFilter`,
`vtkImageToPentatopeMeshFilter`, `vtkPentatopeMeshTimeSlice`, `vtkSimplexMeshQuality` and, where files can be read
(`HAVE_IO`), `vtkSegmentationReader` and `vtkSimplexMeshWriter`. They work together with those of
`vtkmodules`; help(voxplex.vtkImageToTetMeshFilter) has the arrays, units and errors of each.

`python3 -m voxplex` runs the command line.
"""

from .arrays import labels, pentatopes, point_ids, points, tets, times, triangles
from .errors import FileError, MeshingCancelled, MeshingError, MeshingWarning
from .files import HAVE_IO, read_frames, read_segmentation, write
from .images import array_from_image, image_from_array, images_from_array
from .installation import VERSION as __version__
from .measuring import quality
from .meshing import MeshingResult, mesh
from .names import label_names, set_label_names
from .vtkVoxplex import (
    vtkImageToPentatopeMeshFilter, vtkImageToSimplexMeshFilter, vtkImageToTetMeshFilter, vtkMeshingStatistics,
    vtkPentatopeMeshTimeSlice, vtkSimplexMeshQuality)

__all__ = [
    "FileError", "HAVE_IO", "MeshingCancelled", "MeshingError", "MeshingResult", "MeshingWarning", "__version__",
    "array_from_image", "image_from_array", "images_from_array", "label_names", "labels", "mesh", "pentatopes",
    "point_ids", "points", "quality", "read_frames", "read_segmentation", "set_label_names", "tets", "times",
    "triangles", "vtkImageToPentatopeMeshFilter", "vtkImageToSimplexMeshFilter", "vtkImageToTetMeshFilter",
    "vtkMeshingStatistics", "vtkPentatopeMeshTimeSlice", "vtkSimplexMeshQuality", "write",
]

if HAVE_IO:
    from .vtkVoxplexIO import vtkSegmentationReader, vtkSimplexMeshWriter

    __all__ += ["vtkSegmentationReader", "vtkSimplexMeshWriter"]
