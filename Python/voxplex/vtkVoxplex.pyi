# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The wrapped classes, for type checkers. VTK 9.1 has no stubs either: methods are untyped."""

from typing import Any

from vtkmodules.vtkCommonCore import vtkObject
from vtkmodules.vtkCommonExecutionModel import vtkImageAlgorithm, vtkUnstructuredGridAlgorithm

class vtkImageToSimplexMeshFilter(vtkUnstructuredGridAlgorithm):
    def __getattr__(self, name: str) -> Any: ...

class vtkImageToTetMeshFilter(vtkImageToSimplexMeshFilter): ...
class vtkImageToPentatopeMeshFilter(vtkImageToSimplexMeshFilter): ...

class vtkMasksToSegmentation(vtkImageAlgorithm):
    def __getattr__(self, name: str) -> Any: ...

class vtkPentatopeMeshTimeSlice(vtkUnstructuredGridAlgorithm):
    def __getattr__(self, name: str) -> Any: ...

class vtkSegmentationRepair(vtkImageAlgorithm):
    def __getattr__(self, name: str) -> Any: ...

class vtkSimplexMeshInterfaces(vtkUnstructuredGridAlgorithm):
    def __getattr__(self, name: str) -> Any: ...

class vtkSimplexMeshQuality(vtkUnstructuredGridAlgorithm):
    def __getattr__(self, name: str) -> Any: ...

class vtkMeshingStatistics(vtkObject):
    def __getattr__(self, name: str) -> Any: ...
