// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file QualityRun.h
 * @brief One execution of vtkSimplexMeshQuality, and what it leaves.
 */
#ifndef voxplex_QualityRun_h
#define voxplex_QualityRun_h

#include "Private/ChosenArray.h"
#include "Quality/MeshMeasurement.h"
#include "Quality/SpaceTimeMeasurement.h"

#include "vtkSimplexMeshQuality.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <stop_token>
#include <vector>

struct vtkSimplexMeshQuality::Internals
{
  std::set<vtkTypeInt64> Labels;
  std::vector<double> FrameTimes;

  // Of the last execution.
  std::optional<voxplex::SpaceTimeMeasurement> SpaceTime; ///< of pentatopes, in place of Figures
  voxplex::MeshMeasurement Figures;

  /** Forgets the last execution. */
  void Clear() { *this = Internals{ this->Labels, this->FrameTimes, {}, {} }; }

  /** The comparison with an image, of a pentatope mesh that of the farthest frame; may be null. */
  const voxplex::ImageComparison* Farthest() const;
  const voxplex::MeshQuality& Shapes() const;

  voxplex::LabelSelection Selection() const
  {
    return { { this->Labels.begin(), this->Labels.end() }, {} };
  }
};

class vtkSimplexMeshQuality::Execution
{
public:
  Execution(
    vtkSimplexMeshQuality* filter, vtkInformationVector** input, vtkInformationVector* output)
    : Filter(filter)
    , Input(input)
    , Output(output)
  {
  }

  /**
   * Fills the outputs and the filter's Internals.
   * @return false if stopped
   * @throws voxplex::Error, std::bad_alloc, std::system_error
   */
  bool Measure();

private:
  bool MeasureTetrahedra();
  bool MeasurePentatopes();
  bool MeasureFrames(voxplex::SpaceTimeMeasurer& quality);
  /** The times at which the image has frames. */
  std::vector<double> TimesOfImage() const;
  voxplex::ChosenArray FrameOfImage(const std::vector<double>& times, std::size_t k) const;
  /** Progress goes from one value towards the other. False if stopped. */
  bool Run(const std::function<void(const std::stop_token&)>& work, double from, double to);
  unsigned Threads() const;
  /** Without smooth distances. */
  voxplex::MeasurementOptions Options() const;

  vtkSimplexMeshQuality* const Filter;
  vtkInformationVector** const Input;
  vtkInformationVector* const Output;
};

#endif
