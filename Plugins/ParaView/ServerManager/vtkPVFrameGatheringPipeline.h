// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVFrameGatheringPipeline
 * @brief   ParaView's executive for a filter that gathers all time steps into one output
 *
 * ParaView replaces the executive of a filter by its own, vtkPVCompositeDataPipeline, unless the
 * proxy names another one (attribute `executive`): this one, for vtkImageToPentatopeMeshFilter. It is
 * ParaView's with what Private/FrameGathering.h mends. Without it the filter would mesh again at each step
 * of an animation.
 */
#ifndef vtkPVFrameGatheringPipeline_h
#define vtkPVFrameGatheringPipeline_h

#include "vtkPVCompositeDataPipeline.h"
#include "vtkVoxplexServerManagerModule.h" // For export macro

#ifndef __VTK_WRAP__
#include "Private/FrameGathering.h"
using vtkPVFrameGatheringPipelineBase = voxplex::FrameGathering<vtkPVCompositeDataPipeline>;
#else
using vtkPVFrameGatheringPipelineBase = vtkPVCompositeDataPipeline;
#endif

class VTKVOXPLEXSERVERMANAGER_EXPORT vtkPVFrameGatheringPipeline
  : public vtkPVFrameGatheringPipelineBase
{
public:
  static vtkPVFrameGatheringPipeline* New();
  vtkTypeMacro(vtkPVFrameGatheringPipeline, vtkPVCompositeDataPipeline);

protected:
  vtkPVFrameGatheringPipeline() = default;
  ~vtkPVFrameGatheringPipeline() override = default;

private:
  vtkPVFrameGatheringPipeline(const vtkPVFrameGatheringPipeline&) = delete;
  void operator=(const vtkPVFrameGatheringPipeline&) = delete;
};

#endif
