// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PentatopeTesting.h
 * @brief What the tests of space-time meshes share: time series, mesh invariants.
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

/** Signed; positive for a pentatope in positive order. */
double Hypervolume(const std::array<Event, 5>& pentatope);

/** A pentatope grid in plain arrays. */
struct Pentatopes
{
  std::vector<Event> Points;
  std::vector<std::array<vtkIdType, 5>> Cells;
  std::vector<long long> Labels;

  std::array<Event, 5> Corners(std::size_t cell) const;
  /** Sum of one label, or of all for label 0. */
  double HypervolumeOf(long long label = 0) const;
};
Pentatopes ReadPentatopes(vtkUnstructuredGrid* grid);

/**
 * Checks all that holds for every mesh: arrays and cell types, positive order, no unused or double
 * point, conforming, the boundary exactly the facets between labels, each with its labels, its order
 * and its points, and closed around each label.
 */
void CheckPentatopeMesh(vtkImageToPentatopeMeshFilter* filter);

/** Whether both outputs are the same in every bit. */
bool SamePentatopeMesh(vtkImageToPentatopeMeshFilter* a, vtkImageToPentatopeMeshFilter* b);

} // namespace testing

#endif
