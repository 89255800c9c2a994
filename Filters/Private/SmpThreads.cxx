// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/SmpThreads.h"

#include "vtkSMPTools.h"

#include <algorithm>

int voxplex::SmpThreads()
{
  return std::max(1, vtkSMPTools::GetEstimatedNumberOfThreads());
}
