// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkFrameGatheringPipeline
 * @brief   executive of a filter that gathers all time steps into one output
 *
 * It mends what VTK's own does not provide for where an algorithm makes the pipeline run once for
 * each time step (CONTINUE_EXECUTING) and its output is the same at all times:
 * - A request for another time does not execute the algorithm, although it announces TIME_RANGE, and
 *   the output does not get the DATA_TIME_STEP of the last input.
 * - If a pass after the first fails, upstream or in the algorithm, the passes end and Update()
 *   returns 0. VTK's executive would run for ever in the first case and return 1 in the second.
 */
#ifndef vtkFrameGatheringPipeline_h
#define vtkFrameGatheringPipeline_h

#include "vtkCompositeDataPipeline.h"

class vtkFrameGatheringPipeline : public vtkCompositeDataPipeline
{
public:
  static vtkFrameGatheringPipeline* New();
  vtkTypeMacro(vtkFrameGatheringPipeline, vtkCompositeDataPipeline);

protected:
  vtkFrameGatheringPipeline() = default;
  ~vtkFrameGatheringPipeline() override = default;

  using vtkCompositeDataPipeline::ForwardUpstream;
  int ForwardUpstream(vtkInformation* request) override;
  int ExecuteData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int NeedToExecuteBasedOnTime(vtkInformation* outputInformation, vtkDataObject* data) override;
  void MarkOutputsGenerated(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkFrameGatheringPipeline(const vtkFrameGatheringPipeline&) = delete;
  void operator=(const vtkFrameGatheringPipeline&) = delete;

  bool Failed = false; ///< a pass of the present execution
};

#endif
