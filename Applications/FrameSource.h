// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FrameSource.h
 * @brief A series of frames as the beginning of a temporal pipeline.
 */
#ifndef voxplex_cli_FrameSource_h
#define voxplex_cli_FrameSource_h

#include "Parameters.h"
#include "ScalarImage.h"

#include <vtkImageAlgorithm.h>

namespace voxplex::cli
{

/** Announces the time of each frame, and gives the one that is asked for without copying voxels. */
class FrameSource : public vtkImageAlgorithm
{
public:
  static FrameSource* New();
  vtkTypeMacro(FrameSource, vtkImageAlgorithm);

  void SetFrames(const ScalarImage& frames, Space space);

protected:
  FrameSource();

  int RequestInformation(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  int FrameAt(double time) const;

  ScalarImage Frames;
  Space FrameSpace = Space::LPS;
};

} // namespace voxplex::cli

#endif
