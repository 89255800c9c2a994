# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The wrapped classes of reading and writing, for type checkers. Built where GDCM is found."""

from typing import Any

from vtkmodules.vtkCommonExecutionModel import vtkImageAlgorithm
from vtkmodules.vtkIOCore import vtkWriter

class vtkSegmentationReader(vtkImageAlgorithm):
    def __getattr__(self, name: str) -> Any: ...

class vtkSimplexMeshWriter(vtkWriter):
    def __getattr__(self, name: str) -> Any: ...
