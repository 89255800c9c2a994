// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Execution.h
 * @brief What the executions of all filters have in common.
 */
#ifndef voxplex_Private_Execution_h
#define voxplex_Private_Execution_h

#include "Private/SmpThreads.h"
#include "StopRequest.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkVersion.h"

/**
 * For ProcessRequest(): what stopped the last execution does not stop the next one. This request comes before the first
 * progress event, whose observers may stop it. In VTK 9.2 and before the executive sees to it. (It is no function,
 * because SetAbortExecute() would modify the filter.)
 */
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20220823)
#define VOXPLEX_FORGET_ABORT(request)                                                              \
  if ((request)->Has(vtkStreamingDemandDrivenPipeline::REQUEST_DATA_NOT_GENERATED()) &&            \
    !(request)->Get(vtkStreamingDemandDrivenPipeline::CONTINUE_EXECUTING()))                       \
  {                                                                                                \
    this->AbortExecute = 0;                                                                        \
  }
#else
#define VOXPLEX_FORGET_ABORT(request)
#endif

namespace voxplex
{

/** An array that an algorithm processes. Without a name: the active scalars of the points, or else of the cells. */
inline void SetArray(vtkAlgorithm* filter, int index, int port, int connection = 0,
  int association = vtkDataObject::FIELD_ASSOCIATION_POINTS_THEN_CELLS, const char* name = nullptr)
{
  if (name && *name) // not the filter's own, which may be what called
  {
    filter->vtkAlgorithm::SetInputArrayToProcess(index, port, connection, association, name);
  }
  else
  {
    filter->SetInputArrayToProcess(index, port, connection,
      vtkDataObject::FIELD_ASSOCIATION_POINTS_THEN_CELLS, vtkDataSetAttributes::SCALARS);
  }
}

/** Empties all outputs of a filter that failed or was stopped. */
inline void EmptyOutputs(vtkInformationVector* outputs)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    if (vtkDataObject* const output = vtkDataObject::GetData(outputs, port))
    {
      output->Initialize();
    }
  }
}

/** @param chosen 0: as many threads as vtkSMPTools uses */
inline unsigned ThreadsFor(int chosen)
{
  return static_cast<unsigned>(chosen > 0 ? chosen : SmpThreads());
}

/** Nothing here can be made piece by piece. Optional inputs may be missing. */
inline void RequestWholeInputs(vtkInformationVector** inputs, int ports)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  for (int port = 0; port < ports; ++port)
  {
    for (int i = 0; i < inputs[port]->GetNumberOfInformationObjects(); ++i)
    {
      vtkInformation* const input = inputs[port]->GetInformationObject(i);
      if (input->Has(Pipeline::WHOLE_EXTENT()))
      {
        input->Set(Pipeline::UPDATE_EXTENT(), input->Get(Pipeline::WHOLE_EXTENT()), 6);
      }
      input->Set(Pipeline::UPDATE_PIECE_NUMBER(), 0);
      input->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), 1);
      input->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
    }
  }
}

} // namespace voxplex

#endif
