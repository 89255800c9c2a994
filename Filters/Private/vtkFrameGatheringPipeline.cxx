// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/vtkFrameGatheringPipeline.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkFrameGatheringPipeline);
