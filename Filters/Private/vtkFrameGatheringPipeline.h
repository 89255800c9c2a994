// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkFrameGatheringPipeline
 * @brief   executive of a filter that gathers all time steps into one output
 *
 * VTK's own with what Private/FrameGathering.h mends.
 */
#ifndef vtkFrameGatheringPipeline_h
#define vtkFrameGatheringPipeline_h

#include "Private/FrameGathering.h"

#include "vtkCompositeDataPipeline.h"

class vtkFrameGatheringPipeline : public voxplex::FrameGathering<vtkCompositeDataPipeline>
{
public:
  static vtkFrameGatheringPipeline* New();
  vtkTypeMacro(vtkFrameGatheringPipeline, vtkCompositeDataPipeline);

protected:
  vtkFrameGatheringPipeline() = default;
  ~vtkFrameGatheringPipeline() override = default;

private:
  vtkFrameGatheringPipeline(const vtkFrameGatheringPipeline&) = delete;
  void operator=(const vtkFrameGatheringPipeline&) = delete;
};

#endif
