// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PentatopeTesting.h
 * @brief What the tests of space-time meshes share: time series.
 */
#ifndef PentatopeTesting_h
#define PentatopeTesting_h

#include "FilterTesting.h"

#include "vtkImageAlgorithm.h"
#include "vtkImageToPentatopeMeshFilter.h"

namespace testing
{

/** x, y, z, t. */
using Event = std::array<double, 4>;

/** A label at a position and a time. */
using MovingLabel = std::function<double(const Vector& x, double t)>;

/** 0, step, 2 step, ... */
std::vector<double> EqualTimes(int frames, double step = 1.0);

/** A temporal pipeline of images that are made when asked for. */
class TemporalSource : public vtkImageAlgorithm
{
public:
  static TemporalSource* New();
  vtkTypeMacro(TemporalSource, vtkImageAlgorithm);

  std::vector<double> Times;                                   ///< announced as TIME_STEPS
  std::function<vtkSmartPointer<vtkImageData>(int)> MakeFrame; ///< null: fails at this frame
  std::vector<double> Asked;                                   ///< times, in the order of requests

protected:
  TemporalSource();
  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override;
  int RequestData(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override;
};

/** Frames of this label at these times. */
vtkSmartPointer<TemporalSource> MakeSeries(const Placement& placement,
  const std::vector<double>& times, const MovingLabel& label, int type = VTK_UNSIGNED_CHAR);

/** The same as one image with a component for each frame. */
vtkSmartPointer<vtkImageData> MakeComponents(const Placement& placement,
  const std::vector<double>& times, const MovingLabel& label, int type = VTK_UNSIGNED_CHAR);

/** 12^3 unit voxels, small enough for many executions. */
Placement SmallPlacement();

/** A 4-ball, label 3 where x is below its centre's, label 7 elsewhere. */
MovingLabel TwoLabelBall(const Event& centre, double radius);

/** One thread, no picking, on the small placement's TwoLabelBall over 12 frames. */
vtkSmartPointer<vtkImageToPentatopeMeshFilter> MakePentatopeFilter();
vtkSmartPointer<vtkImageToPentatopeMeshFilter> MakePentatopeFilter(vtkAlgorithm* source);

} // namespace testing

#endif
