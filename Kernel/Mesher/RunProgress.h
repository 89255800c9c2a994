// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RunProgress.h
 * @brief The progress of a run.
 */
#ifndef voxplex_RunProgress_h
#define voxplex_RunProgress_h

#include <algorithm>
#include <atomic>

namespace voxplex
{

/**
 * Progress that the stages of a run share with the reporting thread. A run may refine several
 * times.
 */
class RunProgress
{
public:
  /** The fraction done, 0 to 1. May be called from any thread. */
  double Fraction() const { return this->Reached.load(); }

  void EndPreparation() { this->Reached = this->Start; }

  /** Begins another mesh, if the number of meshes is unknown. */
  void BeginOneOfSeveral() { this->End = this->Start + ShareOfOne * (RefinementEnd - this->Start); }
  void EndOneOfSeveral() { this->Start = this->End; }

  /** @param part the approximate fraction of the refinement that is done; may be larger than 1 */
  void Refine(double part)
  {
    this->Reached = this->Start + (this->End - this->Start) * std::min(LargestPart, part);
  }
  void EndRefinement() { this->Reached = this->End; }

private:
  static constexpr double PreparationEnd = 0.2;
  static constexpr double RefinementEnd = 0.95;
  /** If there are several meshes, each takes this share of the remaining progress. */
  static constexpr double ShareOfOne = 0.6;
  static constexpr double LargestPart = 0.98;

  std::atomic<double> Reached{ 0.0 };
  double Start = PreparationEnd; ///< of the current refinement
  double End = RefinementEnd;
};

} // namespace voxplex

#endif
