# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# Sets ITK_FOUND: whether vtkSegmentationRepair, the one class that needs ITK, is built.
set(ITKVtkGlue_LOADED ON) # or ITK 5.4 loads all of VTK
find_package(ITK 5.2 QUIET COMPONENTS ITKCommon ITKDistanceMap ITKLabelMap)
