// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file StopRequest.h
 * @brief Whether a filter or a reader shall stop.
 */
#ifndef voxplex_StopRequest_h
#define voxplex_StopRequest_h

#include <vtkAlgorithm.h>
#include <vtkVersion.h>

namespace voxplex
{

inline bool IsStopRequested(vtkAlgorithm* algorithm)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 3, 0)
  // CheckAbort() knows of filters further down the pipeline, but not of SetAbortExecute().
  return algorithm->GetAbortExecute() != 0 || algorithm->CheckAbort();
#else
  return algorithm->GetAbortExecute() != 0;
#endif
}

} // namespace voxplex

#endif
