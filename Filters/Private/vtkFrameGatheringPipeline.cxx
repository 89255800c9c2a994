// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/vtkFrameGatheringPipeline.h"

#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkFrameGatheringPipeline);

int vtkFrameGatheringPipeline::ForwardUpstream(vtkInformation* request)
{
  const int result = this->Superclass::ForwardUpstream(request);
  if (!result && request->Has(REQUEST_DATA()))
  {
    this->Failed = true;
    this->ContinueExecuting = 0;
  }
  return result;
}

int vtkFrameGatheringPipeline::ExecuteData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  // The passes after the first run inside the first one's call.
  const bool isFirst = this->ContinueExecuting == 0;
  if (isFirst)
  {
    this->Failed = false;
  }
  const int result = this->Superclass::ExecuteData(request, inputVector, outputVector);
  this->Failed = this->Failed || !result;
  return isFirst && this->Failed ? 0 : result;
}

int vtkFrameGatheringPipeline::NeedToExecuteBasedOnTime(vtkInformation*, vtkDataObject*)
{
  return 0;
}

void vtkFrameGatheringPipeline::MarkOutputsGenerated(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->Superclass::MarkOutputsGenerated(request, inputVector, outputVector);
  for (int port = 0; port < outputVector->GetNumberOfInformationObjects(); ++port)
  {
    if (vtkDataObject* data = vtkDataObject::GetData(outputVector, port))
    {
      data->GetInformation()->Remove(vtkDataObject::DATA_TIME_STEP());
    }
  }
}
