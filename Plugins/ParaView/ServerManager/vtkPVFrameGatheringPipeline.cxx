// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVFrameGatheringPipeline.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPVFrameGatheringPipeline);
