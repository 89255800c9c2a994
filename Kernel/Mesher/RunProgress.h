// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RunProgress.h
 * @brief How far a run is.
 */
#ifndef voxplex_RunProgress_h
#define voxplex_RunProgress_h

#include <algorithm>
#include <atomic>

namespace voxplex
{

/** What the stages of a run share with the thread that reports. A run may refine several times. */
class RunProgress
{
public:
  /** 0 to 1. Safe to ask for from any thread. */
  double Fraction() const { return this->Reached.load(); }

  void EndPreparation() { this->Reached = this->Start; }

  /** One more mesh is made, of an unknown number. */
  void BeginOneOfSeveral() { this->End = this->Start + ShareOfOne * (RefinementEnd - this->Start); }
  void EndOneOfSeveral() { this->Start = this->End; }

  /** @param part of the refinement, about; it may be larger than 1 */
  void Refine(double part)
  {
    this->Reached = this->Start + (this->End - this->Start) * std::min(LargestPart, part);
  }
  void EndRefinement() { this->Reached = this->End; }

private:
  static constexpr double PreparationEnd = 0.2;
  static constexpr double RefinementEnd = 0.95;
  /** Each of several meshes takes this share of what is left. */
  static constexpr double ShareOfOne = 0.6;
  static constexpr double LargestPart = 0.98;

  std::atomic<double> Reached{ 0.0 };
  double Start = PreparationEnd; ///< of the refinement
  double End = RefinementEnd;
};

} // namespace voxplex

#endif
