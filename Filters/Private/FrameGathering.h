// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FrameGathering.h
 * @brief What an executive needs for a filter that gathers all time steps into one output.
 *
 * It mends what VTK's own does not provide for where an algorithm makes the pipeline run once for
 * each time step (CONTINUE_EXECUTING) and its output is the same at all times:
 * - A request for another time does not execute the algorithm, although it announces TIME_RANGE, and
 *   the output does not get the DATA_TIME_STEP of the last input.
 * - If a pass after the first fails, upstream or in the algorithm, the passes end and Update()
 *   returns 0. VTK's executive would run for ever in the first case and return 1 in the second.
 *
 * ParaView has an executive of its own, so this can be put upon any that derives from
 * vtkStreamingDemandDrivenPipeline.
 */
#ifndef voxplex_FrameGathering_h
#define voxplex_FrameGathering_h

#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"

namespace voxplex
{

template <class Base>
class FrameGathering : public Base
{
protected:
  using Base::ForwardUpstream;
  int ForwardUpstream(vtkInformation* request) override
  {
    const int result = this->Base::ForwardUpstream(request);
    if (!result && request->Has(Base::REQUEST_DATA()))
    {
      this->Failed = true;
      this->ContinueExecuting = 0;
    }
    return result;
  }

  int ExecuteData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override
  {
    // The passes after the first run inside the first one's call.
    const bool isFirst = this->ContinueExecuting == 0;
    if (isFirst)
    {
      this->Failed = false;
    }
    const int result = this->Base::ExecuteData(request, inputVector, outputVector);
    this->Failed = this->Failed || !result;
    return isFirst && this->Failed ? 0 : result;
  }

  int NeedToExecuteBasedOnTime(vtkInformation*, vtkDataObject*) override { return 0; }

  void MarkOutputsGenerated(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override
  {
    this->Base::MarkOutputsGenerated(request, inputVector, outputVector);
    for (int port = 0; port < outputVector->GetNumberOfInformationObjects(); ++port)
    {
      if (vtkDataObject* data = vtkDataObject::GetData(outputVector, port))
      {
        data->GetInformation()->Remove(vtkDataObject::DATA_TIME_STEP());
      }
    }
  }

private:
  bool Failed = false; ///< a pass of the present execution
};

} // namespace voxplex

#endif
